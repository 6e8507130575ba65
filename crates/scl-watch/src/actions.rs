//! What a page may ask for: commands of `scl`.

use scl_observe::Commands;
use serde::Deserialize;
use serde_json::{Value as Json, json};

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

impl Action {
    /// Does it. Returns what was printed, and whether it was done.
    pub(crate) async fn run(&self, commands: &Commands) -> Json {
        let set;
        let (name, options, words): (_, &[&str], Vec<&str>) = match self {
            Self::Restart { component } => ("restart", &[], vec![component]),
            Self::Stop { component } => ("stop", &[], vec![component]),
            Self::Set { parameter, value } => {
                set = format!("{parameter}={value}");
                ("set", &[], vec![&set])
            }
            Self::Call { gate, request } => ("call", &[], vec![gate, request]),
            Self::Template { gate } => ("call", &["--template"], vec![gate]),
        };
        match commands.run(name, options, &words).await {
            Ok(done) => {
                let text = [done.stdout, done.stderr].concat();
                json!({"done": done.status.success(), "text": String::from_utf8_lossy(&text)})
            }
            Err(error) => json!({"done": false, "text": error}),
        }
    }
}
