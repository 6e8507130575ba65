//! `transport` and `transports`: the transport of all connections, and of single ones.

use super::names::unknown_gate;
use super::reader::{Keys, Reader};
use super::rules::WRONG_NAME;
use scl::TransportKind;
use scl_terminal::quoted_list;
use scl_text::gate_name::split;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::suggest::similar;
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
        let gates = self.named_entries(top, "transports", |reader, problem, field| {
            let problem = match field.value.text() {
                Some(word) => reader.whole(problem, field, format!("transport: {word}")),
                None => reader.as_one_mapping(problem, field),
            };
            problem.otherwise("it names gates as `component.gate`, each with its transport")
        });
        Transports { all, of_gates: gates.into_iter().filter_map(|field| self.read_gate(field)).collect() }
    }

    fn read_gate(&mut self, field: Field<'_>) -> Option<(String, String)> {
        let name = field.key;
        self.check_gate(name, field.key_span);
        let read = transport(field.value);
        if read.is_none() {
            self.wrong_form(field, "transport", &format!("the transport of `{name}`"));
        }
        Some((name.to_owned(), read?))
    }

    /// Checks the name of a gate, also against the topology if there is one: a wrong name would have no effect.
    fn check_gate(&mut self, name: &str, at: Span) {
        let parts = split(name).filter(|_| name.split('.').all(is_word));
        let Some((component, _)) = parts else {
            let problem = WRONG_NAME.at(format!("a gate is named `component.gate`, not `{name}`"), at, "");
            let problem = self.gates_like(problem, name, at);
            return self.report(problem);
        };
        let Some(known) = self.known.filter(|known| !known.gates.iter().any(|gate| gate == name)) else { return };
        let is_far = || similar(name, known.gates.iter().map(String::as_str)).is_empty();
        // A component that is wrong at several places is one mistake.
        if !known.components.iter().any(|it| it == component) && (self.started.contains(component) || is_far()) {
            let is_written = (at.end - at.start) as usize == name.len();
            let at = if is_written { Span { end: at.start + component.len() as u32, ..at } } else { at };
            return self.check_component(component, at);
        }
        let problem = unknown_gate(name, at, &known.gates);
        let of_component = |gate: &&String| split(gate).is_some_and(|(owner, _)| owner == component);
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

impl Reader<'_> {
    /// Adds the gates that a name without a dot, or with too many, may mean: those of a component, or one of that name.
    fn gates_like(&self, problem: Diagnostic, name: &str, at: Span) -> Diagnostic {
        let gates = self.known.map(|known| known.gates.as_slice()).unwrap_or_default();
        let last = name.rsplit(['.', '/', ':']).next().unwrap_or(name);
        let parts: Vec<&str> = name.split(['.', '/', ':']).filter(|part| !part.is_empty()).collect();
        let fits = |gate: &&String| match split(gate) {
            Some((component, gate)) if parts.len() == 1 => component == name || gate == name,
            Some((component, gate)) => parts.contains(&component) && gate == last,
            None => false,
        };
        // A connection names two gates.
        let ends: Vec<&str> = name.split([' ', ',', '>', '-', '=', '[', ']']).filter(|end| end.contains('.')).collect();
        let is_end = |gate: &&String| ends.len() > 1 && ends.contains(&gate.as_str());
        let fitting: Vec<&String> = gates.iter().filter(|gate| fits(gate) || is_end(gate)).take(4).collect();
        if fitting.len() > 3 || (at.end - at.start) as usize != name.len() {
            return problem;
        }
        fitting.iter().fold(problem, |problem, gate| {
            problem.suggest(format!("did you mean `{gate}`?"), [Edit::new(at, gate.as_str())])
        })
    }
}

fn transport(value: &Node) -> Option<String> {
    value.text().filter(|word| TransportKind::of(word).is_some()).map(str::to_owned)
}

/// Whether this can be part of a gate's name: programs read the names from a list with commas and equals signs.
fn is_word(text: &str) -> bool {
    !text.is_empty() && !text.contains(|letter: char| letter.is_whitespace() || ".,=\0".contains(letter))
}
