//! The reader that all parts of a launch file share: it collects problems and checks keys.

use super::super::system_names::SystemNames;
use super::keys::{Key, is_own};
use super::rules::{UNKNOWN_KEY, WRONG_SHAPE};
use super::value::shown;
use super::{LaunchFile, rules};
use scl_terminal::{closest_name, quoted_list};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Rule};
use scl_topology::parse::{Dialect, Document, Field, Fields, damaged_key, fields};
use scl_topology::source::{SourceFile, Span};
use scl_topology::suggest::similar;
use scl_topology::yaml::{Node, NodeKind};

/// Walks the values and collects the problems; every `read_*` continues after a mistake.
pub(super) struct Reader<'a> {
    pub(super) source: &'a SourceFile,
    /// The names of the topology.
    pub(super) known: Option<&'a SystemNames>,
    dialect: &'static Dialect,
    problems: Diagnostics,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a SourceFile, known: Option<&'a SystemNames>, dialect: &'static Dialect) -> Self {
        Self { source, known, dialect, problems: Diagnostics::new() }
    }

    /// Reads the whole file.
    pub(super) fn read(mut self, document: &Document) -> (LaunchFile, Diagnostics) {
        let file = document.root.as_ref().filter(|root| !root.is_null()).map(|root| self.read_file(root));
        (file.unwrap_or_default(), self.problems)
    }

    pub(super) fn report(&mut self, problem: Diagnostic) {
        self.problems.push(problem);
    }

    /// Reads a mapping whose keys are names; `owner` is what messages say after "in".
    pub(super) fn names<'n>(&mut self, entries: &'n [(Node, Node)], owner: &str) -> Fields<'n> {
        fields(entries, owner, self.source, self.dialect, &mut self.problems)
    }

    /// The keys of a mapping; those that are not `allowed` are reported.
    pub(super) fn keys<'n, 'k>(
        &mut self,
        entries: &'n [(Node, Node)],
        allowed: impl IntoIterator<Item = &'k Key>,
        owner: &str,
    ) -> Keys<'n, 'k> {
        self.keys_but(|_| false, entries, allowed, owner)
    }

    /// Like [`keys`](Self::keys), but does not report keys for which `ignored` returns true.
    pub(super) fn keys_but<'n, 'k>(
        &mut self,
        ignored: impl Fn(&str) -> bool,
        entries: &'n [(Node, Node)],
        allowed: impl IntoIterator<Item = &'k Key>,
        owner: &str,
    ) -> Keys<'n, 'k> {
        let keys = Keys { fields: self.names(entries, owner), allowed: allowed.into_iter().collect() };
        for field in &keys.fields.list {
            if !ignored(field.key) && !keys.allowed.iter().any(|key| key.name == field.key) {
                self.report(unknown_key(*field, &keys.allowed, owner));
            }
        }
        keys
    }

    /// Returns the entries of a mapping. Any other value is reported with `message` and `help`, unless it could not be
    /// read, which has been reported.
    pub(super) fn entries<'n>(&mut self, field: Field<'n>, message: &str, help: &str) -> Option<&'n [(Node, Node)]> {
        let entries = field.value.entries();
        if entries.is_none() && !matches!(field.value.kind, NodeKind::Unread) {
            let problem = damaged_key(field.value, self.source, self.dialect).unwrap_or_else(|| {
                wrong(&WRONG_SHAPE, format!("{message}, not {}", shown(field.value)), field).help(help)
            });
            self.report(problem);
        }
        entries
    }

    /// The entries of a key whose value is a mapping from names; none without the key.
    pub(super) fn named_entries<'n>(&mut self, keys: &Keys<'n, '_>, key: &str, help: &str) -> Vec<Field<'n>> {
        let entries = keys.get(key).and_then(|field| self.entries(field, &format!("`{key}` is a mapping"), help));
        entries.map(|entries| self.names(entries, &format!("`{key}`")).list).unwrap_or_default()
    }

    /// Reports a component that is not among `known`, the components of `source`.
    pub(super) fn check_among(&mut self, name: &str, at: Span, known: &[String], source: &str) {
        if known.iter().any(|it| it == name) {
            return;
        }
        let problem = unknown_name(format!("unknown component `{name}`"), name, at, known);
        self.report(problem.note(format!("{source} has the components {}", quoted_list(known))));
    }
}

/// The keys that a mapping has, and the keys that it may have.
pub(super) struct Keys<'n, 'k> {
    pub(super) fields: Fields<'n>,
    allowed: Vec<&'k Key>,
}

impl<'n> Keys<'n, '_> {
    pub(super) fn get(&self, key: &str) -> Option<Field<'n>> {
        self.fields.get(key)
    }

    /// The names in the mapping that is the value of a key.
    pub(super) fn names_of(&self, key: &str) -> Vec<String> {
        let entries = self.get(key).and_then(|field| field.value.entries()).into_iter().flatten();
        entries.filter_map(|(name, _)| name.text()).map(str::to_owned).collect()
    }

    /// Whether the mapping has the key, or may have it: misspelt, or in a part that could not be read. Both have been
    /// reported.
    pub(super) fn may_have(&self, key: &str) -> bool {
        let means_it = |field: &Field<'_>| likely_key(field.key, &self.allowed) == Some(key);
        self.fields.damaged || self.get(key).is_some() || self.fields.list.iter().any(means_it)
    }
}

/// The problem of an unknown name, with the `known` names that may have been meant.
pub(super) fn unknown_name(message: String, name: &str, at: Span, known: &[String]) -> Diagnostic {
    let near = similar(name, known.iter().map(String::as_str));
    rules::UNKNOWN_NAME.at(message, at, "").did_you_mean(name, &near)
}

fn unknown_key(field: Field<'_>, allowed: &[&Key], owner: &str) -> Diagnostic {
    let problem = UNKNOWN_KEY.at(format!("unknown key `{}` in {owner}", field.key), field.key_span, "");
    match likely_key(field.key, allowed) {
        _ if is_own(field.key) => {
            problem.help("keys of your own, which start with `x-`, belong at the top of the file")
        }
        Some(close) => problem.did_you_mean(field.key, &[close]),
        None => problem.note(format!("the keys are {}", quoted_list(allowed.iter().map(|key| key.name)))),
    }
}

/// The key that an unknown one probably means: another tool's word for it, or a similar name.
fn likely_key<'k>(word: &str, allowed: &[&'k Key]) -> Option<&'k str> {
    let lower = word.to_lowercase().replace(['-', ' '], "_");
    let named = allowed.iter().find(|key| key.also.contains(&lower.as_str()));
    named.map(|key| key.name).or_else(|| closest_name(&lower, allowed.iter().map(|key| key.name)))
}

/// The place of the value of a field, or of its key if the value is empty.
pub(super) fn value_span(field: Field<'_>) -> Span {
    let span = field.value.span;
    if span.start == span.end { field.key_span } else { span }
}

/// A problem of a key or its value.
pub(super) fn wrong(rule: &'static Rule, message: impl Into<String>, field: Field<'_>) -> Diagnostic {
    rule.at(message, value_span(field), "")
}
