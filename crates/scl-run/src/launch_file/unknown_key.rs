//! Keys that a launch file does not have: misspelt, at the wrong level, or of another tool.

use super::command::is_part;
use super::habits::Habit;
use super::keys::{self, Key, is_called, is_own};
use super::likely::{fits, likely};
use super::likely_key::{MOST_KEYS, NOT_ESSENTIAL, PLACES, likely_key, likely_keys, problem};
use super::reader::{Keys, Reader};
use super::shape::variables;
use super::words::bare;
use scl_terminal::quoted_list;
use scl_text::gate_name::split;
use scl_topology::diagnostic::{Diagnostic, Edit};
use scl_topology::parse::Field;
use scl_topology::source::Span;
use scl_topology::yaml::Node;
use std::collections::HashSet;

/// Maximum number of components that are searched for the name of a host.
const MOST_COMPONENTS: usize = 1_000;

/// Whether a key of another tool names a program, or a part of its command.
pub(super) fn names_program(key: &str) -> bool {
    is_part(key) || Habit::of(key).is_some_and(|habit| !habit.can_go)
}

impl Reader<'_> {
    /// Reports the keys of a mapping that are not allowed there; `ignored` ones are not.
    /// Those at the places `told` have been reported.
    pub(super) fn check_keys(
        &mut self,
        keys: &Keys<'_, '_>,
        ignored: impl Fn(&str) -> bool,
        told: &HashSet<Span>,
        owner: &str,
    ) {
        let is_told = |field: &&Field<'_>| told.contains(&field.key_span);
        let is_allowed = |field: &&Field<'_>| is_told(field) || keys.allowed.iter().any(|key| key.name == field.key);
        let unknown: Vec<Field<'_>> =
            keys.fields.list.iter().filter(|field| !ignored(field.key) && !is_allowed(field)).copied().collect();
        let has_command = keys.allowed.iter().any(|key| key.name == "command");
        let is_command = has_command && self.check_command_parts(keys, &unknown, owner);
        let unknown: Vec<Field<'_>> = unknown.into_iter().filter(|field| !(is_command && is_part(field.key))).collect();
        let mut told: Vec<&str> = Vec::new();
        for field in &unknown {
            let meant = likely_keys(field.key, &keys.allowed);
            let same = |other: &&Field<'_>| {
                let of_other = likely_keys(other.key, &keys.allowed);
                of_other.first() == meant.first() && other.key_span != field.key_span
            };
            match meant.first() {
                // Several words for the same key are one mistake.
                Some(key) if told.contains(key) => continue,
                Some(key) => told.push(key),
                None => {}
            }
            let others: Vec<Field<'_>> = match meant.is_empty() {
                true => Vec::new(),
                false => unknown.iter().filter(same).copied().collect(),
            };
            let problem = self.unknown_key(*field, &others, keys, &meant, owner);
            self.report(problem);
        }
    }

    fn unknown_key(
        &self,
        field: Field<'_>,
        others: &[Field<'_>],
        keys: &Keys<'_, '_>,
        meant: &[&str],
        owner: &str,
    ) -> Diagnostic {
        let problem = problem(field.key, field.key_span, owner);
        if is_own(field.key) {
            return problem.help("keys of your own, which start with `x-`, belong at the top of the file");
        }
        let is_negated = NOT_ESSENTIAL.contains(&bare(field.key).as_str());
        let can_be = || keys.allowed.iter().any(|key| key.name == "essential") && keys.get("essential").is_none();
        if is_negated && can_be() {
            return self.negated(problem, field, "essential");
        }
        let is_mapping = field.value.entries().is_some();
        if matches!(bare(field.key).as_str(), "profile" | "profiles") && owner.starts_with("component") {
            return self.moved_to_profile(problem, field, owner.trim_start_matches("component ").trim_matches('`'));
        }
        let habit = Habit::of(field.key).filter(|habit| meant.is_empty() || is_mapping && !habit.parts.is_empty());
        if let Some(habit) = habit {
            return self.habit(problem, field, habit, keys);
        }
        if let Some(known) = meant.iter().find(|key| keys.get(key).is_some()) {
            let problem = problem.note(format!("`{known}` is there already"));
            return self.without(
                problem,
                field,
                format!("`{known}` is what this is called here: remove one of the two"),
            );
        }
        match meant {
            [] => self.misplaced(problem, field, keys, owner),
            // Keys of which one removes the other are one mistake.
            [key] if others.is_empty() && fits(key, field.value) => {
                problem.did_you_mean(field.key, &[key]).otherwise(format!("`{key}` is what this is called here"))
            }
            _ => {
                let problem = problem.labels(others.iter().map(|other| (other.key_span, "the same")));
                meant.iter().fold(problem, |problem, key| self.renamed(problem, field, others, key))
            }
        }
    }

    /// Proposes another key, with a value that it accepts.
    fn renamed(&self, problem: Diagnostic, field: Field<'_>, others: &[Field<'_>], key: &str) -> Diagnostic {
        let removed: Option<Vec<Edit>> = others.iter().map(|other| self.remove_entry(*other)).collect();
        let value = self.written(field.value.span);
        let guess = likely(key, field.value);
        let values = match fits(key, field.value) {
            true => vec![value.to_owned()],
            false if key == "environment" => variables(field.value),
            false => guess.values,
        };
        if let Some(list) = self.without_names(field).filter(|_| matches!(key, "components" | "hosts" | "profiles")) {
            let edits = [Edit::new(field.key_span, key), list];
            let text = format!("write `{key}`, and each name as a key, in place of its `-`");
            let otherwise = format!("`{key}` is what this is called here: {}", keys::form_of(key).description());
            return problem.suggest(text, edits).otherwise(otherwise);
        }
        let edits = |value: &str| {
            let entry = self.replace_entry(field, format!("{key}: {value}"))?;
            Some([vec![entry], removed.clone()?].concat())
        };
        let is_short = |value: &str| !value.contains('\n') && !value.is_empty();
        let problem = values.iter().fold(problem, |problem, value| match edits(value).filter(|_| is_short(value)) {
            Some(edits) => problem.suggest(format!("write `{key}: {value}`"), edits),
            None => problem,
        });
        problem.otherwise(format!("`{key}` is what this is called here: {}", keys::form_of(key).description()))
    }

    /// A word that means the opposite of a key with `true` or `false`.
    fn negated(&self, problem: Diagnostic, field: Field<'_>, key: &str) -> Diagnostic {
        let meant = match fits(key, field.value) {
            true => field.value.text().map(str::to_lowercase),
            false => likely(key, field.value).values.into_iter().next(),
        };
        match meant {
            Some(value) => self.whole(problem, field, format!("{key}: {}", value != "true")),
            None => problem.help(format!("`{key}` is what this is called here, with the opposite value")),
        }
    }

    /// Proposes to remove a key.
    pub(super) fn without(&self, problem: Diagnostic, field: Field<'_>, text: String) -> Diagnostic {
        match self.remove_entry(field) {
            Some(edit) => problem.suggest(text, [edit]),
            None => problem,
        }
    }

    /// A key of another level, or one that no level has.
    fn misplaced(&self, problem: Diagnostic, field: Field<'_>, keys: &Keys<'_, '_>, owner: &str) -> Diagnostic {
        let levels =
            [(keys::TOP, ""), (keys::COMPONENT, "component"), (keys::HOST, "host"), (keys::GATEWAY, "gateway")];
        let bare_word = bare(field.key);
        let find = |level: &'static [Key]| {
            level
                .iter()
                .find(|key| key.name == field.key)
                .or_else(|| level.iter().find(|key| is_called(key, &bare_word)))
        };
        let is_here = |level: &[Key]| keys.allowed.iter().all(|key| level.iter().any(|other| other.name == key.name));
        let mut others = levels.iter().filter(|(level, _)| !is_here(level));
        let known = others.find_map(|(level, name)| Some((find(level)?.name, *name)));
        if owner.starts_with("component") && PLACES.contains(&bare(field.key).as_str()) {
            return self.placed(problem, field, owner);
        }
        if keys.allowed.iter().any(|key| key.name == "command") && is_part(field.key) {
            return problem.note("`command` has the program and all of its arguments");
        }
        if keys.allowed.len() < keys::COMPONENT.len() && owner == "`defaults`" && find(keys::COMPONENT).is_some() {
            let environment = find(keys::COMPONENT).filter(|key| key.name == "environment");
            return match environment {
                Some(key) => self.at_the_top(problem, field, key.name),
                None if keys::TOP.iter().any(|key| key.name == field.key) => {
                    let problem = self.at_the_top(problem, field, field.key);
                    problem.help("or into the entries of components, if it is not the same for all")
                }
                None => problem.help(format!("`{}` belongs into the entries of components", field.key)),
            };
        }
        let problem = match known {
            Some(("transport", "")) if owner.starts_with("component") => {
                return self.own_transport(problem, field, owner);
            }
            Some((key, "")) => return self.at_the_top(problem, field, key),
            Some((key, "component")) if owner == "a launch file" => return self.for_all(problem, field, key),
            Some((key, "component")) => problem.help(format!("`{key}` belongs into the entries of components")),
            Some((key, "host")) => problem.help(format!("`{key}` belongs into the entry of a host, in `hosts`")),
            Some((key, level)) => return self.in_gateway(problem, field, key, level),
            None => problem,
        };
        problem.note(format!("the keys are {}", quoted_list(keys.allowed.iter().map(|key| key.name))))
    }

    /// A key that belongs at the top of the file: moves it there if it fits in one line and is not there yet.
    fn at_the_top(&self, problem: Diagnostic, field: Field<'_>, key: &str) -> Diagnostic {
        let text = format!("`{key}` belongs at the top of the file");
        let moved = || {
            let root = self.root?;
            let entry = format!("{key}: {}", self.in_brackets(field.value)?);
            self.top_value(key).is_none().then_some(())?;
            Some([self.remove_entry(field)?, self.add_entry(root, &entry)?])
        };
        self.moved(problem, text, moved())
    }

    /// A key of components at the top of the file: moves it into `defaults`.
    fn for_all(&self, problem: Diagnostic, field: Field<'_>, key: &str) -> Diagnostic {
        if !keys::COMPONENT.iter().any(|known| known.name == key && known.in_defaults) {
            return problem.help(format!("`{key}` belongs into the entries of components"));
        }
        let text = format!("for all components, `{key}` stands in `defaults`");
        let moved = || {
            let value = match fits(key, field.value) {
                true => self.in_brackets(field.value)?,
                false => likely(key, field.value).values.into_iter().next()?,
            };
            let entry = format!("{key}: {value}");
            match self.top_value("defaults") {
                Some(defaults) => Some(vec![self.remove_entry(field)?, self.add_entry(defaults, &entry)?]),
                None => Some(vec![self.replace_entry(field, format!("defaults: {{{entry}}}"))?]),
            }
        };
        self.moved(problem, text, moved())
    }

    /// A key of `gateway` elsewhere: moves it there.
    fn in_gateway(&self, problem: Diagnostic, field: Field<'_>, key: &str, level: &str) -> Diagnostic {
        let moved = || {
            let entry = format!("{key}: {}", self.in_brackets(field.value)?);
            Some([self.remove_entry(field)?, self.add_entry(self.top_value(level)?, &entry)?])
        };
        self.moved(problem, format!("`{key}` belongs into `{level}`"), moved())
    }

    /// Proposes to move a key, or says where it belongs.
    fn moved(&self, problem: Diagnostic, text: String, edits: Option<impl IntoIterator<Item = Edit>>) -> Diagnostic {
        match edits {
            Some(edits) => problem.suggest(text.clone(), edits).otherwise(text),
            None => problem.help(text),
        }
    }

    /// `transport` of a component: the transports of its gates, at the top of the file.
    fn own_transport(&self, problem: Diagnostic, field: Field<'_>, owner: &str) -> Diagnostic {
        let component = owner.trim_start_matches("component ").trim_matches('`');
        let text = "`transports` at the top of the file has the transports of single gates";
        let gates = self.known.map(|known| known.gates.as_slice()).unwrap_or_default();
        let is_own = |gate: &&String| split(gate).is_some_and(|(of, _)| of == component);
        let moved = || {
            let word = field.value.text()?;
            let entries: Vec<String> =
                gates.iter().filter(is_own).take(8).map(|gate| format!("{gate}: {word}")).collect();
            (!entries.is_empty()).then_some(())?;
            let added = match self.top_value("transports") {
                Some(transports) if self.is_flow(transports) => self.add_entry(transports, &entries.join(", "))?,
                Some(transports) => self.add_entry(transports, &entries.join("\n  "))?,
                None => self.add_entry(self.root?, &format!("transports: {{{}}}", entries.join(", ")))?,
            };
            Some(([self.remove_entry(field)?, added], entries.join(", ")))
        };
        match moved() {
            Some((edits, entries)) => problem.suggest(format!("{text}: `transports: {{{entries}}}`"), edits),
            None => problem.help(format!("{text}, named `component.gate`")),
        }
    }

    /// A component that says where it runs: the host lists it.
    fn placed(&self, problem: Diagnostic, field: Field<'_>, owner: &str) -> Diagnostic {
        let component = owner.trim_start_matches("component ").trim_matches('`');
        let problem = problem.note("a host lists its components, in `hosts` at the top of the file");
        let host = || {
            let name = field.value.text()?;
            let hosts = self.top_value("hosts")?.entries()?;
            let (_, host) = hosts.iter().find(|(key, _)| key.text() == Some(name))?;
            let listed = host.entries()?.iter().find(|(key, _)| key.text() == Some("components"));
            let added = match listed.map(|(_, list)| (list, list.items())) {
                None => self.add_entry(host, &format!("components: [{component}]"))?,
                Some((_, Some(items))) if items.iter().any(|item| item.text() == Some(component)) => {
                    return Some((vec![self.remove_entry(field)?], name));
                }
                Some((list, Some(items))) if self.is_flow(list) => {
                    let end = items.last()?.span;
                    Edit::new(Span { start: end.end, ..end }, format!(", {component}"))
                }
                _ => return None,
            };
            Some((vec![self.remove_entry(field)?, added], name))
        };
        match host() {
            Some((edits, name)) => {
                problem.suggest(format!("list `{component}` in `components` of host `{name}`, and remove this"), edits)
            }
            None => problem,
        }
    }

    /// Whether a component says that it runs on this host, which was reported.
    pub(super) fn is_named_by_component(&self, host: &str) -> bool {
        let components = self.top_value("components").and_then(Node::entries).unwrap_or_default();
        let components = components.iter().take(MOST_COMPONENTS);
        let names = |(key, value): &(Node, Node)| {
            key.text().is_some_and(|key| PLACES.contains(&bare(key).as_str())) && value.text() == Some(host)
        };
        components.filter_map(|(_, entry)| entry.entries()).flatten().any(names)
    }
}

impl<'n> Keys<'n, '_> {
    /// The mapping that is the value of a key, or of the one that is written in its place, which was reported.
    pub(super) fn section(&self, key: &str) -> Option<Field<'n>> {
        let is_meant =
            |field: &&Field<'n>| field.value.entries().is_some() && likely_key(field.key, &self.allowed) == Some(key);
        self.get(key).or_else(|| self.fields.list.iter().take(MOST_KEYS).find(is_meant).copied())
    }
}

impl<'a> Reader<'a> {
    /// The value of a key at the top of the file.
    pub(super) fn top_value(&self, key: &str) -> Option<&'a Node> {
        let entries = self.root?.entries()?;
        entries.iter().find(|(name, _)| name.text() == Some(key)).map(|(_, value)| value)
    }
}
