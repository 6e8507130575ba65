//! Components and gates that the topology does not have. A name that is wrong at several places is one mistake.

use super::reader::Reader;
use super::rules::UNKNOWN_NAME;
use scl_terminal::quoted_list;
use scl_text::gate_name::split;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::source::Span;
use scl_topology::suggest::similar;
use scl_topology::yaml::Node;

/// Maximum number of places of a name that a proposal changes.
const MOST_PLACES: usize = 100;

impl<'a> Reader<'a> {
    /// Whether the topology has a component of this name.
    pub(super) fn is_component(&self, name: &str) -> bool {
        self.known.is_some_and(|known| known.components.iter().any(|known| known == name))
    }

    /// Reports a component that the topology does not have or, without a topology, the launch file.
    pub(super) fn check_component(&mut self, name: &str, at: Span) {
        let is_known = match self.known {
            Some(known) => known.components.iter().any(|it| it == name),
            None => self.started.is_empty() || self.started.contains(name),
        };
        if is_known {
            return;
        }
        let unknown = &mut self.unknown;
        let index = *unknown.indices.entry(name.to_owned()).or_insert_with(|| {
            unknown.found.push((name.to_owned(), Vec::new()));
            unknown.found.len() - 1
        });
        unknown.found[index].1.push(at);
    }

    /// Reports a component that the topology does not have, if there is a topology.
    pub(super) fn check_entry_name(&mut self, name: &str, at: Span) {
        if self.known.is_some() {
            self.check_component(name, at);
        }
    }

    /// Whether there is a topology, and it has neither a component nor a kind of this name.
    pub(super) fn is_unknown(&self, name: &str) -> bool {
        self.known.is_some() && !self.is_component(name) && self.components_of(name).is_none()
    }

    /// Reports the unknown components, each once.
    pub(super) fn report_unknown_names(&mut self) {
        let found = std::mem::take(&mut self.unknown).found;
        let entries = self.top_value("components").and_then(Node::entries).unwrap_or_default();
        let (source, known): (_, Vec<&str>) = match self.known {
            Some(known) => ("the topology", known.components.iter().map(String::as_str).collect()),
            None => ("the launch file", entries.iter().filter_map(|(key, _)| key.text()).collect()),
        };
        for (name, places) in found {
            let Some(first) = places.first() else { continue };
            let others = || places.iter().skip(1).map(|place| (*place, "here too"));
            if let Some(components) = self.components_of(&name) {
                let message = format!("`{name}` is a kind; components are listed here");
                let problem = UNKNOWN_NAME.at(message, *first, "").labels(others());
                self.report(self.offer(problem, &name, &places, &[&components.join(", ")]));
                continue;
            }
            let problem = UNKNOWN_NAME.at(format!("unknown component `{name}`"), *first, "").labels(others());
            let near = similar(&name, known.iter().copied().chain(self.kinds()));
            let longer: Vec<&str> = match near.is_empty() {
                true => known.iter().copied().filter(|known| has_part(known, &name)).take(4).collect(),
                false => Vec::new(),
            };
            let is_gate = split(&name).filter(|(component, _)| known.contains(component));
            let unused = || known.iter().copied().filter(|known| !self.started.contains(known));
            let problem = match (is_gate, near.is_empty(), places.len()) {
                (Some((component, _)), ..) => {
                    let problem = problem.note("components are listed here, not gates");
                    self.offer(problem, &name, &places, &[component])
                }
                (None, false, 1) => problem.did_you_mean(&name, &near),
                (None, false, _) => self.offer(problem, &name, &places, &near),
                _ if !longer.is_empty() && longer.len() < 4 => self.offer(problem, &name, &places, &longer),
                // The component that has no entry may have another name here.
                _ => {
                    let unused: Vec<&str> = unused().take(4).collect();
                    if unused.len() < 4 { self.offer(problem, &name, &places, &unused) } else { problem }
                }
            };
            let problem = match near.is_empty() && self.known.is_some() && unused().next().is_none() {
                true => problem.note("a launch file starts the components of the topology, and nothing else"),
                false => problem,
            };
            let problem = problem.note(format!("{source} has the components {}", quoted_list(&known)));
            let kinds: Vec<&str> = self.kinds().collect();
            self.report(problem.notes((!kinds.is_empty()).then(|| format!("and the kinds {}", quoted_list(&kinds)))));
        }
    }

    fn kinds(&self) -> impl Iterator<Item = &'a str> + use<'a> {
        self.known.into_iter().flat_map(|known| &known.kinds).map(|(kind, _)| kind.as_str())
    }

    /// Proposes other names at all places of a name: they are possible only, because the topology may be wrong.
    fn offer(&self, problem: Diagnostic, name: &str, places: &[Span], names: &[&str]) -> Diagnostic {
        if places.len() > MOST_PLACES || places.iter().any(|place| self.written(*place) != name) {
            return problem;
        }
        names.iter().fold(problem, |problem, meant| {
            let edits = places.iter().map(|place| Edit::new(*place, *meant));
            problem.suggest(format!("did you mean `{meant}`?"), edits)
        })
    }
}

/// Whether a name has the words of another one, and more.
fn has_part(name: &str, part: &str) -> bool {
    let behind = name.strip_prefix(part).is_some_and(|rest| rest.starts_with(['_', '-']));
    behind || name.strip_suffix(part).is_some_and(|rest| rest.ends_with(['_', '-']))
}

/// The problem of an unknown gate, with the `known` gates that may have been meant.
pub(super) fn unknown_gate(name: &str, at: Span, known: &[String]) -> Diagnostic {
    let problem = UNKNOWN_NAME.at(format!("unknown gate `{name}`"), at, "");
    let near = similar(name, known.iter().map(String::as_str));
    if !near.is_empty() {
        return problem.did_you_mean(name, &near);
    }
    let of_component = |gate: &&str| split(gate).map(|(owner, _)| owner) == split(name).map(|(owner, _)| owner);
    let own: Vec<&str> = known.iter().map(String::as_str).filter(of_component).take(4).collect();
    let is_few = own.len() < 4 && (at.end - at.start) as usize == name.len();
    own.iter()
        .filter(|_| is_few)
        .fold(problem, |problem, gate| problem.suggest(format!("did you mean `{gate}`?"), [Edit::new(at, *gate)]))
}
