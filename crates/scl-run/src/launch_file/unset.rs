//! Parameters without a default for which a launch file has no value.

use super::entry::{LaunchComponent, Source};
use super::rules::UNSET;
use super::{LaunchFile, SystemNames};
use scl_plan::ParameterPlan;
use scl_terminal::quoted_list;
use scl_topology::diagnostic::Diagnostic;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::collections::{HashMap, HashSet};

/// Warns of parameters that get a value neither in `components` nor in a profile: `--set` may give them one.
pub(super) fn unset_parameters(root: &Node, file: &LaunchFile, known: &SystemNames) -> Vec<Diagnostic> {
    let of_components = file.components.iter().map(|component| (&component.name, &component.parameters));
    let of_profiles = file.entries_of_profiles().map(|entry| (&entry.name, &entry.parameters));
    let entries = of_components.chain(of_profiles);
    let given: HashSet<(&str, &str)> =
        entries.flat_map(|(component, values)| values.iter().map(|(name, _)| (component.as_str(), &**name))).collect();
    let places = Places::new(root);
    let mut found: Vec<(Span, &ParameterPlan, Vec<&str>)> = Vec::new();
    let mut indices: HashMap<(Span, &str), usize> = HashMap::new();
    for component in started(file) {
        let Some(place) = places.of(component, known) else { continue };
        for plan in known.without_value(component, |name| given.contains(&(component, name))) {
            let index = *indices.entry((place, &plan.name)).or_insert_with(|| {
                found.push((place, plan, Vec::new()));
                found.len() - 1
            });
            found[index].2.push(component);
        }
    }
    found.iter().map(|(place, plan, components)| unset(*place, plan, components)).collect()
}

fn unset(place: Span, plan: &ParameterPlan, components: &[&str]) -> Diagnostic {
    let (name, kind) = (&plan.name, &plan.kind);
    let message = match components {
        [component] => format!("parameter `{component}.{name}` ({kind}) has no value"),
        _ => format!("parameter `{name}` ({kind}) of {} has no value", quoted_list(components)),
    };
    let problem = UNSET.at(message, place, "").help(format!("add `parameters: {{{name}: ...}}`"));
    problem.note("the topology declares it without a default")
}

/// The components that a program runs, with a profile or without, each once.
fn started(file: &LaunchFile) -> Vec<&str> {
    let is_program = |source: &Source| matches!(source, Source::Command(_));
    let in_components = file.components.iter().filter(|component: &&LaunchComponent| is_program(&component.source));
    let in_components = in_components.map(|component| component.name.as_str());
    let in_profiles = file.entries_of_profiles().filter(|entry| entry.source.as_ref().is_some_and(is_program));
    let mut seen = HashSet::new();
    in_components.chain(in_profiles.map(|entry| entry.name.as_str())).filter(|name| seen.insert(*name)).collect()
}

/// The places of the entries: those of `components`, then those of each profile.
struct Places<'n>(Vec<HashMap<&'n str, Span>>);

impl<'n> Places<'n> {
    fn new(root: &'n Node) -> Self {
        let get = |key: &str| root.entries()?.iter().find(|(name, _)| name.text() == Some(key)).map(|(_, value)| value);
        let profiles = get("profiles").and_then(Node::entries).unwrap_or_default().iter().map(|(_, profile)| profile);
        let names = |section: &'n Node| {
            let entries = section.entries().unwrap_or_default().iter();
            entries.filter_map(|(key, _)| Some((key.text()?, key.span))).collect()
        };
        Self(get("components").into_iter().chain(profiles).map(names).collect())
    }

    /// The first entry of a component, or of its kind.
    fn of(&self, component: &str, known: &SystemNames) -> Option<Span> {
        let find = |section: &HashMap<&str, Span>| {
            let of_kind = || section.get(known.kind_of(component)?);
            section.get(component).or_else(of_kind).copied()
        };
        self.0.iter().find_map(find)
    }
}
