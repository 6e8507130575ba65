//! `profiles`: other programs for the same components.

use super::super::terminal::StandardInput;
use super::LaunchFile;
use super::entry::{Entry, LaunchComponent, Opens};
use super::keys;
use super::reader::{Keys, Reader};
use super::rules::WRONG_SHAPE;
use scl_terminal::{Problem, quoted_list};
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// A named set of entries that replace or change those of `components`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Profile {
    name: String,
    entries: Vec<Entry>,
}

impl LaunchFile {
    /// The components with these profiles applied in order: later ones win.
    ///
    /// # Errors
    ///
    /// Every name that is not a profile of this file, and two components with `input: terminal`.
    pub(crate) fn components_with(&self, profiles: &[String]) -> Result<Vec<LaunchComponent>, Vec<Problem>> {
        let mut components = self.components.clone();
        let mut problems = Vec::new();
        for name in profiles {
            match self.profiles.iter().find(|profile| profile.name == *name) {
                Some(profile) => profile.entries.iter().for_each(|entry| apply(entry, &mut components)),
                None => problems.push(self.unknown_profile(name)),
            }
        }
        problems.extend(several_with_terminal(&components));
        if problems.is_empty() { Ok(components) } else { Err(problems) }
    }

    fn unknown_profile(&self, name: &str) -> Problem {
        let names = || self.profiles.iter().map(|profile| profile.name.as_str());
        let problem = Problem::new(format!("unknown profile `{name}`"));
        if self.profiles.is_empty() {
            return problem.note("the launch file has no `profiles`");
        }
        let problem = problem.did_you_mean(name, names());
        problem.note(format!("the launch file has the profiles {}", quoted_list(names())))
    }
}

/// Reports two components with `input: terminal`: only one process group can be in the foreground of a terminal.
fn several_with_terminal(components: &[LaunchComponent]) -> Option<Problem> {
    let mut with_terminal = components.iter().filter(|component| component.input == StandardInput::Terminal);
    let (first, second) = (with_terminal.next()?, with_terminal.next()?);
    let message = format!("the components `{}` and `{}` both have `input: terminal`", first.name, second.name);
    Some(
        Problem::new(message).at(&second.place).help("one component can read from the terminal: remove one of the two"),
    )
}

/// Applies an entry. A command or a recording replaces the program, and resets the keys that belong to the old one:
/// `build`, `working_directory`, `opens` and `input`. Variables are added; all other keys replace the component's.
fn apply(entry: &Entry, components: &mut Vec<LaunchComponent>) {
    let Some(component) = components.iter_mut().find(|component| component.name == entry.name) else {
        components.extend(entry.clone().into_component());
        return;
    };
    component.environment.extend(entry.environment.iter().cloned());
    if let Some(source) = &entry.source {
        component.source.clone_from(source);
        component.build = None;
        component.settings.working_directory = None;
        component.opens = Opens::Own;
        component.input = StandardInput::Empty;
        component.place.clone_from(&entry.place);
    }
    if let Some(opens) = &entry.opens {
        component.opens.clone_from(opens);
    }
    if let Some(input) = entry.input {
        component.input = input;
    }
    if entry.build.is_some() {
        component.build.clone_from(&entry.build);
    }
    component.settings = entry.settings.clone().over(&component.settings);
}

impl Reader<'_> {
    /// Reads all profiles, whether or not they are used. A component that is not in `components` needs a command.
    pub(super) fn read_profiles(&mut self, top: &Keys<'_, '_>) -> Vec<Profile> {
        let profiles = self.named_entries(top, "profiles", |reader, problem, field| {
            reader.as_mapping(problem, field).otherwise("each profile has entries like those of `components`")
        });
        let started = top.names_of("components");
        profiles.into_iter().filter_map(|profile| self.read_profile(profile, &started)).collect()
    }

    fn read_profile(&mut self, field: Field<'_>, started: &[String]) -> Option<Profile> {
        let name = field.key;
        let message = format!("profile `{name}` is a mapping from components to entries");
        let entries = self.entries(field, &message, |reader, problem| {
            reader.as_mapping(problem, field).otherwise("its entries are like those of `components`")
        })?;
        let misplaced =
            self.without_component(field, entries, started).or_else(|| self.with_components(field, entries));
        if let Some(problem) = misplaced {
            self.report(problem);
            return None;
        }
        let entries = self.names(entries, &format!("profile `{name}`")).list;
        let is_new = |component: &str| !started.iter().any(|name| name == component);
        let entries = entries.into_iter().filter_map(|entry| self.read_entry(entry, is_new(entry.key))).collect();
        Some(Profile { name: name.to_owned(), entries })
    }

    /// The problem of a profile that has the keys of an entry in place of components.
    fn without_component(&self, field: Field<'_>, entries: &[(Node, Node)], started: &[String]) -> Option<Diagnostic> {
        let is_key = |(key, _): &(Node, Node)| {
            let key = key.text().unwrap_or_default();
            keys::COMPONENT.iter().any(|known| known.name == key) && !started.iter().any(|name| name == key)
        };
        if entries.is_empty()
            || !entries.iter().all(is_key)
            || entries.iter().any(|(_, value)| value.entries().is_some())
        {
            return None;
        }
        let (first, last) = (entries.first()?, entries.last()?);
        let name = field.key;
        let message = format!("profile `{name}` has the key `{}` in place of components", first.0.text()?);
        let problem =
            WRONG_SHAPE.at(message, first.0.span, "").note("a profile is a mapping from components to entries");
        let all = first.0.span.to(last.1.span);
        let entry = self.written(all);
        // The component whose program it is: the one that the entry names, or the only one.
        let named: Vec<&String> = started.iter().filter(|name| entry.contains(name.as_str())).collect();
        let likely = if named.is_empty() && started.len() < 4 { started.iter().collect() } else { named };
        let column = self.source.column(all.start);
        Some(likely.into_iter().take(3).fold(problem, |problem, component| {
            let (help, text) = match entry.contains('\n') {
                false => (format!("write `{component}: {{{entry}}}`"), format!("{component}: {{{entry}}}")),
                true => {
                    let inner = format!("\n{}  {}", " ".repeat(column), entry.replace('\n', "\n  "));
                    (format!("write `{component}:` above it, and indent it"), format!("{component}:{inner}"))
                }
            };
            problem.suggest(help, [Edit::new(all, text)])
        }))
    }

    /// The problem of a profile whose entries stand in one more `components`.
    fn with_components(&self, field: Field<'_>, entries: &[(Node, Node)]) -> Option<Diagnostic> {
        let [(key, inner)] = entries else { return None };
        let first = inner.entries()?.first().filter(|_| key.text() == Some("components"))?.0.span;
        if self.known.is_some_and(|known| known.components.iter().any(|name| name == "components")) {
            return None;
        }
        let message = format!("profile `{}` has `components` in place of their entries", field.key);
        let problem = WRONG_SHAPE.at(message, key.span, "").note("a profile is a mapping from components to entries");
        let written = self.written(inner.span);
        let column = |span: Span| self.source.column(span.start);
        let deeper = "\n".to_owned() + &" ".repeat(column(first).saturating_sub(column(key.span)));
        let text = match (self.is_flow(inner), self.is_flow(field.value)) {
            (true, true) => written.trim_matches(['{', '}']).to_owned(),
            (true, false) => return Some(problem),
            _ => written.replace(&deeper, "\n"),
        };
        Some(problem.propose("remove `components:`", [Edit::new(key.span.to(inner.span), text)]))
    }
}
