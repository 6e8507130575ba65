//! Other commands of `scl`, run for a user who is elsewhere: so that a page can do what the command line can, with the
//! same checks and the same words.

use std::path::PathBuf;
use std::process::{Output, Stdio};
use tokio::process::Command;

/// How to run commands of `scl` for one system.
#[derive(Debug, Clone)]
pub struct Commands {
    program: PathBuf,
    system: String,
}

impl Commands {
    /// `program` is `scl`.
    #[must_use]
    pub fn new(program: PathBuf, system: &str) -> Self {
        Self { program, system: system.to_owned() }
    }

    /// A command with nothing at standard input, which ends when it is dropped. `words` are never taken for options.
    #[must_use]
    pub fn command(&self, name: &str, options: &[&str], words: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.arg(name).args(["--system", &self.system]).args(options).arg("--").args(words);
        command.stdin(Stdio::null()).kill_on_drop(true);
        command
    }

    /// Runs a command to its end. It is killed if the future is dropped before.
    ///
    /// # Errors
    /// Why it cannot be run.
    pub async fn run(&self, name: &str, options: &[&str], words: &[&str]) -> Result<Output, String> {
        self.command(name, options, words).output().await.map_err(|error| self.cannot_run(&error))
    }

    /// Says why the command could not be started.
    #[must_use]
    pub fn cannot_run(&self, error: &std::io::Error) -> String {
        format!("cannot run `{}`: {error}", self.program.display())
    }
}
