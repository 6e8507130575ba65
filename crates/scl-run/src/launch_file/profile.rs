//! `profiles`: other programs for the same components.

use super::super::terminal::StandardInput;
use super::LaunchFile;
use super::entry::{Entry, LaunchComponent, Opens};
use super::keys;
use super::reader::{Keys, Reader};
use super::rules::WRONG_SHAPE;
use super::value::texts;
use scl_terminal::{Problem, quoted_list};
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;

/// Maximum number of entries that a key is moved to.
const MOST_MOVED: usize = 4;

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
        let entries = self.without_outdented(entries, keys::COMPONENT);
        let entries = self.names(&entries, &format!("profile `{name}`")).list;
        let (entries, others) = self.without_keys(field, entries, started);
        others.into_iter().for_each(|problem| self.report(problem));
        let entries = entries.into_iter().filter_map(|entry| self.read_entry(entry, Some((name, started)))).collect();
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

    /// The entries of components in a profile, and the problems of keys that stand beside them.
    fn without_keys<'n>(
        &self,
        profile: Field<'_>,
        entries: Vec<Field<'n>>,
        started: &[String],
    ) -> (Vec<Field<'n>>, Vec<Diagnostic>) {
        let is_name = |field: &Field<'_>| {
            let is_key = keys::COMPONENT.iter().chain(keys::TOP).any(|key| key.name == field.key);
            !is_key || self.is_component(field.key) || started.iter().any(|name| name == field.key)
        };
        let (entries, keys): (Vec<_>, Vec<_>) = entries.into_iter().partition(is_name);
        let problems = keys.into_iter().map(|key| {
            let message = format!("profile `{}` has the key `{}` in place of a component", profile.key, key.key);
            let problem = WRONG_SHAPE.at(message, key.key_span, "").note("a profile holds entries of components only");
            if keys::COMPONENT.iter().all(|known| known.name != key.key) {
                return problem.help(format!("`{}` belongs at the top of the file", key.key));
            }
            let moved = || {
                let entry = format!("{}: {}", key.key, self.in_brackets(key.value)?);
                let mut edits = vec![self.remove_entry(key)?];
                for component in entries.iter().take(MOST_MOVED) {
                    edits.push(self.add_entry(component.value, &entry)?);
                }
                (entries.len() <= MOST_MOVED && !entries.is_empty()).then_some(edits)
            };
            let names = quoted_list(entries.iter().take(MOST_MOVED).map(|component| component.key));
            let text = format!("`{}` belongs into the entries of components", key.key);
            match moved() {
                Some(edits) => problem.suggest(format!("{text}: move it to {names}"), edits).otherwise(text),
                None => problem.help(text),
            }
        });
        let problems = problems.collect();
        (entries, problems)
    }

    /// Proposes to move an entry of `components`, which names its profile as in Docker Compose, into that profile.
    pub(super) fn moved_to_profile(&self, problem: Diagnostic, field: Field<'_>, component: &str) -> Diagnostic {
        let profile = match texts(field.value).unwrap_or_default().as_slice() {
            [one] => one.clone(),
            _ => field.value.text().unwrap_or("debug").to_owned(),
        };
        let text = format!(
            "move the entry from `components` into a profile, at the top of the file: `profiles: {{{profile}: \
             {{{component}: {{command: ...}}}}}}`"
        );
        let moved = || {
            let root = self.root.filter(|root| !self.is_flow(root) && self.top_value("profiles").is_none())?;
            let entries = self.top_value("components")?.entries()?;
            let (key, value) = entries.iter().find(|(key, _)| key.text() == Some(component))?;
            let whole = Field { key: component, key_span: key.span, key_node: key, value };
            let removed = self.remove_entry(whole).filter(|_| !self.written(value.span).contains('#'))?;
            let others = value.entries()?.iter().filter(|(key, _)| key.span != field.key_span);
            let others = others.map(|(key, value)| self.written(key.span.to(value.span)));
            let entry = match self.is_flow(value) {
                true => format!(" {{{}}}", others.collect::<Vec<_>>().join(", ")),
                false => {
                    let old = format!("\n{}", " ".repeat(self.source.column(value.span.start)));
                    others.map(|entry| format!("\n      {}", entry.replace(&old, "\n      "))).collect()
                }
            };
            let text = format!("profiles:\n  {profile}:\n    {component}:{entry}");
            let added = self.add_last(root, &text)?;
            // The last entry of the file: write the profile in its place.
            let is_last = (removed.span.start..removed.span.end).contains(&added.span.start);
            let in_place = Edit::new(removed.span, format!("{text}\n"));
            (texts(field.value).is_none_or(|names| names.len() == 1))
                .then(|| if is_last { vec![in_place] } else { vec![removed, added] })
        };
        match moved() {
            Some(edits) => problem.suggest(text.clone(), edits).otherwise(text),
            None => problem.help(text),
        }
    }

    /// The problem of a profile whose entries stand in one more `components`.
    fn with_components(&self, field: Field<'_>, entries: &[(Node, Node)]) -> Option<Diagnostic> {
        let [(key, inner)] = entries else { return None };
        let first = inner.entries()?.first().filter(|_| key.text() == Some("components"))?.0.span;
        if self.is_component("components") {
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
