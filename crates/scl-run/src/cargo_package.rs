//! Builds the cargo package of a system and finds its programs.

use scl_terminal::Problem;
use serde::Deserialize;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// A program that cargo has built.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BuiltProgram {
    /// The name of the cargo target.
    pub(crate) name: String,
    /// Path of the executable.
    pub(crate) executable: PathBuf,
}

/// The fields of cargo's messages that are read.
#[derive(Deserialize)]
struct Message {
    reason: String,
    target: Option<Target>,
    executable: Option<PathBuf>,
}

#[derive(Deserialize)]
struct Target {
    name: String,
}

/// Builds the programs of the package in a folder. Cargo's own output is passed through.
///
/// # Errors
///
/// If there is no package, cargo cannot be run, or the build fails.
pub(crate) fn build_package(folder: &Path, release: bool) -> Result<Vec<BuiltProgram>, Problem> {
    if !folder.join("Cargo.toml").is_file() {
        return Err(Problem::new(format!("there is no cargo package in `{}`", folder.display()))
            .help("add a `launch.yaml` that says how each component is started; `scl run --help` shows one"));
    }
    let cannot = |error| Problem::new(format!("cannot run cargo: {error}"));
    let mut cargo = cargo_build(folder, release).spawn().map_err(cannot)?;
    let messages = cargo.stdout.take().into_iter().flat_map(|pipe| BufReader::new(pipe).lines().map_while(Result::ok));
    let built = messages.filter_map(|line| read_message(&line)).collect();
    let status = cargo.wait().map_err(cannot)?;
    if status.success() { Ok(built) } else { Err(Problem::new("the programs could not be built")) }
}

fn cargo_build(folder: &Path, release: bool) -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.args(["build", "--bins", "--message-format", "json-render-diagnostics"]);
    command.args(release.then_some("--release"));
    command.current_dir(folder).stdin(Stdio::null()).stdout(Stdio::piped());
    command
}

fn read_message(line: &str) -> Option<BuiltProgram> {
    let message: Message = serde_json::from_str(line).ok()?;
    let is_program = message.reason == "compiler-artifact";
    is_program.then_some(BuiltProgram { name: message.target?.name, executable: message.executable? })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_artifacts_with_an_executable_are_programs() {
        let cases = [
            (r#"{"reason":"compiler-artifact","target":{"name":"s"},"executable":"/t/s"}"#, Some(("s", "/t/s"))),
            (r#"{"reason":"compiler-artifact","target":{"name":"a_library"},"executable":null}"#, None),
            (r#"{"reason":"build-finished","success":true}"#, None),
            ("not json", None),
        ];
        for (line, expected) in cases {
            let expected = expected.map(|(name, path)| BuiltProgram { name: name.into(), executable: path.into() });
            assert_eq!(read_message(line), expected, "{line}");
        }
    }
}
