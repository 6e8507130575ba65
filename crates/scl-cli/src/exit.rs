//! Exit codes of commands, and their problems on standard error.

use scl_terminal::{Problem, print_err};
use std::process::ExitCode;

/// Exit code: the command could not do its work.
pub(crate) const COULD_NOT_DO: u8 = 2;

/// What a command returns.
pub(crate) trait Outcome {
    /// Returns the exit code. A problem is printed, and its exit code is [`COULD_NOT_DO`].
    fn exit_code(self) -> ExitCode;
}

impl Outcome for ExitCode {
    fn exit_code(self) -> ExitCode {
        self
    }
}

impl Outcome for Result<ExitCode, Problem> {
    fn exit_code(self) -> ExitCode {
        self.unwrap_or_else(|problem| {
            print_err(&problem.to_string());
            ExitCode::from(COULD_NOT_DO)
        })
    }
}

#[cfg(feature = "run")]
impl Outcome for Result<ExitCode, Vec<Problem>> {
    fn exit_code(self) -> ExitCode {
        self.unwrap_or_else(|problems| {
            print_problems(&problems);
            ExitCode::from(COULD_NOT_DO)
        })
    }
}

/// Prints problems, each followed by an empty line.
#[cfg(feature = "run")]
pub(crate) fn print_problems(problems: &[Problem]) {
    problems.iter().for_each(|problem| print_err(&format!("{problem}\n")));
}
