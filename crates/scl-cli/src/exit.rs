//! Exit codes of commands, and their problems on standard error.

use scl_terminal::{Problem, print_err};
use std::process::ExitCode;

/// Exit code: the command could not do its work.
pub(crate) const COULD_NOT_DO: u8 = 2;

/// The exit code of a command; a problem is printed and means that the command could not do its work.
pub(crate) fn exit_code(result: Result<ExitCode, Problem>) -> ExitCode {
    result.unwrap_or_else(|problem| {
        print_err(&problem.to_string());
        ExitCode::from(COULD_NOT_DO)
    })
}

/// [`exit_code`] for several problems.
#[cfg(feature = "run")]
pub(crate) fn exit_code_of_all(result: Result<ExitCode, Vec<Problem>>) -> ExitCode {
    result.unwrap_or_else(|problems| {
        print_problems(&problems);
        ExitCode::from(COULD_NOT_DO)
    })
}

/// Prints problems, each followed by an empty line.
#[cfg(feature = "run")]
pub(crate) fn print_problems(problems: &[Problem]) {
    problems.iter().for_each(|problem| print_err(&format!("{problem}\n")));
}
