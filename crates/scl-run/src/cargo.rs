//! Programs that cargo builds: `cargo run` in a launch file becomes a build and the program that cargo names, so that
//! cargo is never the running component.

mod artifacts;
mod metadata;
mod run_command;
mod target;

pub(crate) use artifacts::{Artifact, read_artifacts};
pub(crate) use metadata::built_before;
pub(crate) use run_command::CargoRun;
pub(crate) use target::{Target, find};

/// Options that make cargo report the programs that it has built as JSON, but compiler errors as text.
pub(crate) const MESSAGES: [&str; 2] = ["--message-format", "json-render-diagnostics"];

/// The cargo to run where no command names one: `$CARGO`, or `cargo` in the search path.
pub(crate) fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}
