//! The program `scl-gateway`, which is installed separately from `scl`.

use super::component::Component;
use super::program::is_executable;
use scl_terminal::{Problem, print_err};
use std::path::PathBuf;
use std::process::{Command, Stdio};

/// The name of its file.
const PROGRAM: &str = "scl-gateway";

/// Finds the program beside the running `scl`, or else in the search path.
///
/// # Errors
///
/// If it is in neither.
pub(crate) fn find() -> Result<PathBuf, Problem> {
    let own = std::env::current_exe().ok().and_then(|scl| Some(scl.parent()?.to_owned()));
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut folders = own.into_iter().chain(std::env::split_paths(&path).filter(|folder| folder.is_absolute()));
    folders.find_map(|folder| Some(folder.join(PROGRAM)).filter(|file| is_executable(file))).ok_or_else(missing)
}

/// Lets the gateway check the launch file and its certificates, so that a mistake is reported once, before anything is
/// started. Later failures are retried.
///
/// # Errors
///
/// If the gateway cannot run. Its own message about the reason has been printed.
pub(crate) fn check(gateway: &Component) -> Result<(), Vec<Problem>> {
    let [program, _run, arguments @ ..] = gateway.program.command.as_slice() else { return Ok(()) };
    let mut command = Command::new(program);
    command.arg("check").args(arguments).current_dir(&gateway.program.folder);
    command.envs(gateway.program.environment.iter().cloned()).stdin(Stdio::null()).stdout(Stdio::null());
    let failed = |problem: Problem| vec![problem.note("nothing was started")];
    let cannot_run = |error| failed(Problem::new(format!("cannot run `{}`: {error}", program.display())));
    let output = command.output().map_err(cannot_run)?;
    if output.status.success() {
        return Ok(());
    }
    print_err(&String::from_utf8_lossy(&output.stderr));
    Err(failed(Problem::new("the gateway cannot run with these files")))
}

fn missing() -> Problem {
    Problem::new(format!("the program `{PROGRAM}`, which connects the hosts, is not installed"))
        .help("install it: `cargo install scl-gateway`; in the repository of SCL: `cargo build -p scl-gateway`")
        .note("it is looked for beside `scl`, then in PATH")
}
