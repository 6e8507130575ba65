//! `profiles`: other programs for the same components.

mod misplaced;

use super::super::terminal::StandardInput;
use super::LaunchFile;
use super::entry::{Entry, LaunchComponent, Needs};
use super::keys;
use super::reader::{Keys, Reader};
use super::rules::WRONG_SHAPE;
use scl_terminal::{Problem, quoted_list};
use scl_topology::parse::Field;

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

    /// The entries of all profiles.
    pub(super) fn entries_of_profiles(&self) -> impl Iterator<Item = &Entry> {
        self.profiles.iter().flat_map(|profile| &profile.entries)
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

/// Applies an entry, which may be the first of its component.
pub(super) fn apply(entry: &Entry, components: &mut Vec<LaunchComponent>) {
    match components.iter_mut().find(|component| component.name == entry.name) {
        Some(component) => entry.apply_to(component),
        None => components.extend(entry.clone().into_component()),
    }
}

/// Whether one of the entries declares a profile of this name.
fn is_profile(profiles: &[Field<'_>], name: &str) -> bool {
    profiles.iter().any(|profile| profile.key == name && profile.value.entries().is_some())
}

impl Reader<'_> {
    /// Reads all profiles, whether or not they are used. A component that is not in `components` needs a command.
    pub(super) fn read_profiles(&mut self, top: &Keys<'_, '_>) -> Vec<Profile> {
        let profiles = self.named_entries(top, "profiles", |reader, problem, field| {
            reader.as_mapping(problem, field).otherwise("each profile has entries like those of `components`")
        });
        let started = self.with_components_of_kinds(top.names_of("components"));
        if let Some(problem) = self.without_profile(&profiles, &started) {
            self.report(problem);
            return Vec::new();
        }
        let (chosen, profiles): (Vec<Field<'_>>, Vec<Field<'_>>) =
            profiles.iter().partition(|field| field.value.text().is_some_and(|name| is_profile(&profiles, name)));
        chosen.into_iter().for_each(|field| self.report_chosen(field));
        profiles.into_iter().filter_map(|profile| self.read_profile(profile, &started)).collect()
    }

    /// Reports `active: simulation` among the profiles, where `simulation` is one of them.
    fn report_chosen(&mut self, field: Field<'_>) {
        let name = field.value.text().unwrap_or_default();
        let message = format!("`{}` does not choose profile `{name}`", field.key);
        let problem = WRONG_SHAPE.at(message, field.key_span, "a profile would be declared here");
        let problem = match self.remove_entry(field) {
            Some(edit) => problem.suggest(format!("remove `{}`", field.key), [edit]),
            None => problem,
        };
        self.report(problem.note(format!("a profile is chosen at the start: `scl run --profile {name}`")));
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
        let entries = self.without_outdented(entries, keys::COMPONENT);
        let entries = self.names(&entries, &format!("profile `{name}`")).list;
        let (entries, others) = self.without_keys(field, entries, started);
        others.into_iter().for_each(|problem| self.report(problem));
        let entries = self.read_entries(&entries, |reader, entry, of_kind| {
            let is_started = |name: &str| started.iter().any(|started| started == name);
            let is_known = match reader.components_of(entry) {
                Some(components) => components.iter().all(|name| is_started(name)),
                None => is_started(entry) || of_kind,
            };
            if is_known { Needs::Nothing } else { Needs::ProgramIn(name) }
        });
        Some(Profile { name: name.to_owned(), entries })
    }
}
