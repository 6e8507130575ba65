//! `transport` and `transports`: the transport of all connections, and of single ones.

use super::keys;
use super::reader::{Keys, Reader, unknown_name};
use super::rules::WRONG_NAME;
use scl::TransportKind;
use scl_terminal::quoted_list;
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// The transports that the file chooses.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Transports {
    all: Option<String>,
    /// By gate, in file order.
    of_gates: Vec<(String, String)>,
}

impl Transports {
    /// Returns the value of `SCL_TRANSPORT` for the programs, where `inherited` is its value in this process. `None` if
    /// the file chooses nothing, so that the programs inherit the variable.
    pub(crate) fn variable(&self, inherited: Option<&str>) -> Option<String> {
        if *self == Self::default() {
            return None;
        }
        let all = self.all.as_deref().or(inherited.filter(|value| !value.is_empty()));
        let of_gates = self.of_gates.iter().map(|(gate, word)| format!("{gate}={word}"));
        // The last matching entry wins, so the entries of the file follow the inherited ones.
        Some(all.map(str::to_owned).into_iter().chain(of_gates).collect::<Vec<_>>().join(","))
    }
}

impl Reader<'_> {
    pub(super) fn read_transports(&mut self, top: &Keys<'_, '_>) -> Transports {
        let all = self.read_setting(top, "transport", transport);
        let gates = self.named_entries(top, "transports", "write `transports: {camera.frames: shm}`");
        Transports { all, of_gates: gates.into_iter().filter_map(|field| self.read_gate(field)).collect() }
    }

    fn read_gate(&mut self, field: Field<'_>) -> Option<(String, String)> {
        let name = field.key;
        self.check_gate(name, field.key_span);
        let read = transport(field.value);
        if read.is_none() {
            self.wrong_form(field, keys::form_of("transport"), &format!("the transport of `{name}`"));
        }
        Some((name.to_owned(), read?))
    }

    /// Checks the name of a gate, also against the topology if there is one: a wrong name would have no effect.
    fn check_gate(&mut self, name: &str, at: Span) {
        let parts = name.split_once('.').filter(|(component, gate)| is_word(component) && is_word(gate));
        let Some((component, _)) = parts else {
            let message = format!("a gate is named like `camera.frames`, not `{name}`");
            return self.report(WRONG_NAME.at(message, at, ""));
        };
        let Some(known) = self.known.filter(|known| !known.gates.iter().any(|gate| gate == name)) else { return };
        let problem = unknown_name(format!("unknown gate `{name}`"), name, at, &known.gates);
        let of_component = |gate: &&String| gate.split_once('.').is_some_and(|(owner, _)| owner == component);
        let own: Vec<&String> = known.gates.iter().filter(of_component).collect();
        self.report(problem.note(if known.components.iter().any(|it| it == component) {
            match own.is_empty() {
                true => format!("component `{component}` has no gates"),
                false => format!("component `{component}` has the gates {}", quoted_list(own)),
            }
        } else {
            format!("the topology has the components {}", quoted_list(&known.components))
        }));
    }
}

fn transport(value: &Node) -> Option<String> {
    value.text().filter(|word| TransportKind::of(word).is_some()).map(str::to_owned)
}

/// Whether this can be part of a gate's name: programs read the names from a list with commas and equals signs.
fn is_word(text: &str) -> bool {
    !text.is_empty() && !text.contains(|letter: char| letter.is_whitespace() || ".,=\0".contains(letter))
}
