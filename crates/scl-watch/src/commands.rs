//! Other commands of `scl`, which the server runs for a page: so a page can do what the command line can, with the same
//! checks and the same words.

use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::path::PathBuf;
use std::process::Stdio;
use tokio::process::Command;

/// How to run a command for the system of the page.
#[derive(Debug, Clone)]
pub(crate) struct Commands {
    /// The program `scl`.
    program: PathBuf,
    system: String,
}

/// What a page may ask for, if it may ask for anything.
#[derive(Debug, Deserialize)]
#[serde(tag = "action", rename_all = "lowercase", deny_unknown_fields)]
pub(crate) enum Action {
    /// Starts a component anew.
    Restart { component: String },
    /// Stops a component.
    Stop { component: String },
    /// Sets a live parameter, `component.parameter`.
    Set { parameter: String, value: String },
    /// Sends a request, as YAML, to a `rep` gate.
    Call { gate: String, request: String },
    /// Makes an example request for a `rep` gate.
    Template { gate: String },
}

impl Commands {
    pub(crate) fn new(program: PathBuf, system: &str) -> Self {
        Self { program, system: system.to_owned() }
    }

    /// A command that ends when it is dropped. `words` are never taken for options.
    pub(crate) fn command(&self, name: &str, options: &[&str], words: &[&str]) -> Command {
        let mut command = Command::new(&self.program);
        command.arg(name).args(["--system", &self.system]).args(options).arg("--").args(words);
        command.stdin(Stdio::null()).kill_on_drop(true);
        command
    }

    /// Runs a command to its end. Returns what it printed, and whether it did what was asked.
    pub(crate) async fn run(&self, action: &Action) -> Json {
        let set;
        let (name, options, words): (_, &[&str], Vec<&str>) = match action {
            Action::Restart { component } => ("restart", &[], vec![component]),
            Action::Stop { component } => ("stop", &[], vec![component]),
            Action::Set { parameter, value } => {
                set = format!("{parameter}={value}");
                ("set", &[], vec![&set])
            }
            Action::Call { gate, request } => ("call", &[], vec![gate, request]),
            Action::Template { gate } => ("call", &["--template"], vec![gate]),
        };
        let done = match self.command(name, options, &words).output().await {
            Ok(done) => done,
            Err(error) => {
                return json!({"done": false, "text": format!("cannot run `{}`: {error}", self.program.display())});
            }
        };
        let text = [done.stdout, done.stderr].concat();
        json!({"done": done.status.success(), "text": String::from_utf8_lossy(&text)})
    }
}
