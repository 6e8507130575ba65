//! `transport` and `transports`: the transport of all connections, and of single ones.

use super::keys::{self, Form};
use super::reader::{Reader, shown};
use super::settings::likely;
use scl_terminal::{Problem, quoted_list};
use serde_yaml::Value;

/// The key for single connections.
const KEY: &str = "transports";

/// What the file says of transports.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Transports {
    all: Option<String>,
    /// By gate, in file order.
    of_gates: Vec<(String, String)>,
}

impl Transports {
    /// The value of `SCL_TRANSPORT`, which is `inherited` without this file; `None` if nothing is to be set.
    pub(crate) fn variable(&self, inherited: Option<&str>) -> Option<String> {
        if *self == Self::default() {
            return None;
        }
        let all = self.all.as_deref().or(inherited.filter(|value| !value.is_empty()));
        let of_gates = self.of_gates.iter().map(|(gate, word)| format!("{gate}={word}"));
        // Of several entries, the last one counts: those of the file are after those that are inherited.
        Some(all.map(str::to_owned).into_iter().chain(of_gates).collect::<Vec<_>>().join(","))
    }
}

impl Reader<'_> {
    pub(super) fn read_transports(&mut self, all: Option<&Value>, of_gates: Option<&Value>) -> Transports {
        Transports { all: self.read_transport(all), of_gates: self.read_gates(of_gates) }
    }

    fn read_transport(&mut self, value: Option<&Value>) -> Option<String> {
        let value = value?;
        let word = transport(value);
        if word.is_none() {
            self.wrong_value(&["transport"], value);
        }
        word
    }

    fn read_gates(&mut self, value: Option<&Value>) -> Vec<(String, String)> {
        let entries = match value {
            None => return Vec::new(),
            Some(Value::Mapping(entries)) => entries,
            Some(other) => {
                self.wrong_value(&[KEY], other);
                return Vec::new();
            }
        };
        entries.iter().filter_map(|(gate, word)| self.read_gate(gate, word)).collect()
    }

    fn read_gate(&mut self, gate: &Value, word: &Value) -> Option<(String, String)> {
        let Some(name) = gate.as_str() else {
            let message = format!("a gate is named like `camera.frames`, not {}", shown(gate));
            self.wrong(&[KEY], &message);
            return None;
        };
        self.check_gate(name);
        let read = transport(word);
        if read.is_none() {
            let form = keys::form_of("transport");
            let message = format!("the transport of `{name}` is {}, not {}", form.description(), shown(word));
            let problem = Problem::new(message).at(self.text.place(&[KEY, name]));
            self.problems.push(match likely(form, word) {
                Some(meant) => problem.help(format!("did you mean `{name}: {meant}`?")),
                None => problem,
            });
        }
        Some((name.to_owned(), read?))
    }

    /// A wrong name would change nothing, so it is looked up in the topology where there is one.
    fn check_gate(&mut self, name: &str) {
        let place = self.text.place(&[KEY, name]);
        let parts = name.split_once('.').filter(|(component, gate)| is_word(component) && is_word(gate));
        let Some((component, _)) = parts else {
            let problem = Problem::new(format!("a gate is named like `camera.frames`, not `{name}`"));
            return self.problems.push(problem.at(place));
        };
        let Some(known) = self.known.filter(|known| !known.gates.iter().any(|gate| gate == name)) else { return };
        let gates: Vec<&str> = known.gates.iter().map(String::as_str).collect();
        let problem = Problem::new(format!("unknown gate `{name}`")).at(place);
        let problem = problem.did_you_mean(name, gates.iter().copied());
        let of_component = |gate: &&str| gate.split_once('.').is_some_and(|(owner, _)| owner == component);
        let own: Vec<&str> = gates.into_iter().filter(of_component).collect();
        self.problems.push(problem.note(if known.components.iter().any(|it| it == component) {
            match own.is_empty() {
                true => format!("component `{component}` has no gates"),
                false => format!("component `{component}` has the gates {}", quoted_list(own)),
            }
        } else {
            let names = quoted_list(&known.components);
            format!("the topology has the components {names}")
        }));
    }
}

fn transport(value: &Value) -> Option<String> {
    let is_known = |word: &&str| matches!(keys::form_of("transport"), Form::Word(words) if words.contains(word));
    value.as_str().filter(is_known).map(str::to_owned)
}

/// Whether this can be part of a name: programs read the names from a list with commas and equals signs.
fn is_word(text: &str) -> bool {
    !text.is_empty() && !text.contains(|letter: char| letter.is_whitespace() || ".,=\0".contains(letter))
}
