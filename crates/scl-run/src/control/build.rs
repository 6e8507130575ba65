//! The builds of `scl restart`. The command runs them itself, on its own terminal, while the old processes keep
//! running.

use super::super::ending::Ending;
use super::super::orphan_guard::bound_command;
use super::super::placement::Placement;
use super::protocol::BuildCommand;
use scl_terminal::{Problem, print_err};
use std::ffi::OsString;
use std::io;
use std::os::fd::AsFd;
use std::process::{ExitStatus, Stdio};

/// Runs a build. Its output goes to standard error.
///
/// # Errors
///
/// If it fails.
pub(super) fn run(build: &BuildCommand) -> Result<(), Problem> {
    print_err(&format!("scl: building {}: {}\n", build.owner, build.shown));
    let failed = |why: String| {
        let problem = Problem::new(format!("the build of {} failed, so nothing was restarted", build.owner));
        problem.note(format!("`{}` {why}", build.shown))
    };
    let status = start(build).map_err(|error| failed(format!("cannot be started: {error}")))?;
    if status.success() { Ok(()) } else { Err(failed(Ending::from(status).to_string())) }
}

fn start(build: &BuildCommand) -> io::Result<ExitStatus> {
    let words: Vec<OsString> = build.command.iter().map(OsString::from).collect();
    let mut command = bound_command(&words, &Placement::default(), None);
    command.current_dir(&build.folder).env_clear().envs(&build.environment).stdin(Stdio::null());
    command.stdout(io::stderr().as_fd().try_clone_to_owned()?).status()
}
