//! The reader that all parts of a launch file share: it collects problems and checks keys.

use super::super::system_names::SystemNames;
use super::LaunchFile;
use super::keys::Key;
use super::likely_key::{MOST_KEYS, likely_key};
use scl_topology::diagnostic::{Diagnostic, Diagnostics, Edit, Rule};
use scl_topology::parse::{Dialect, Document, Field, Fields, fields};
use scl_topology::source::{SourceFile, Span};
use scl_topology::yaml::Node;
use std::collections::{HashMap, HashSet};

/// Maximum number of repeated keys in one mapping for which a merge is proposed.
const MOST_REPEATED: usize = 4;

/// Walks the values and collects the problems; every `read_*` continues after a mistake.
pub(super) struct Reader<'a> {
    pub(super) source: &'a SourceFile,
    /// The names of the topology.
    pub(super) known: Option<&'a SystemNames>,
    pub(super) dialect: &'static Dialect,
    /// The value of the whole file.
    pub(super) root: Option<&'a Node>,
    /// The names in `components`, and the components of the kinds among them.
    pub(super) started: HashSet<&'a str>,
    /// The components that the topology does not have.
    pub(super) unknown: UnknownNames,
    /// The keys at the top of the file that are missing above their entries.
    pub(super) missing_sections: Vec<&'static str>,
    problems: Diagnostics,
}

/// The unknown components of a file with their places.
#[derive(Default)]
pub(super) struct UnknownNames {
    /// In the order of their first places.
    pub(super) found: Vec<(String, Vec<Span>)>,
    pub(super) indices: HashMap<String, usize>,
}

impl<'a> Reader<'a> {
    pub(super) fn new(source: &'a SourceFile, known: Option<&'a SystemNames>, dialect: &'static Dialect) -> Self {
        Self {
            source,
            known,
            dialect,
            root: None,
            started: HashSet::new(),
            unknown: UnknownNames::default(),
            missing_sections: Vec::new(),
            problems: Diagnostics::new(),
        }
    }

    /// Reads the whole file.
    pub(super) fn read(mut self, document: &'a Document) -> (LaunchFile, Diagnostics) {
        self.root = document.root.as_ref().filter(|root| !root.is_null());
        let entries = self.top_value("components").and_then(Node::entries).unwrap_or_default();
        self.started = entries.iter().filter_map(|(key, _)| key.text()).collect();
        let of_kinds: Vec<&str> =
            self.started.iter().filter_map(|name| self.components_of(name)).flatten().map(String::as_str).collect();
        self.started.extend(of_kinds);
        let file = self.root.map(|root| self.read_file(root));
        self.report_unknown_names();
        (file.unwrap_or_default(), self.problems)
    }

    pub(super) fn report(&mut self, problem: Diagnostic) {
        self.problems.push(problem);
    }

    /// Reads a mapping whose keys are names; `owner` is what messages say after "in".
    pub(super) fn names<'n>(&mut self, entries: &'n [(Node, Node)], owner: &str) -> Fields<'n> {
        let fields = fields(entries, owner, self.source, self.dialect, &mut self.problems);
        for second in fields.repeated.iter().take(MOST_REPEATED) {
            let Some(first) = fields.get(second.key) else { continue };
            if first.value.entries().is_none() || second.value.entries().is_none() {
                continue;
            }
            let moved = self.moved_up(first, *second);
            let removed = [("second", *second), ("first", first)]
                .map(|(which, field)| Some((format!("remove the {which} one"), vec![self.remove_entry(field)?])));
            let ways = match moved {
                Some(edits) => {
                    vec![(format!("write what is here in the first `{}`", second.key), edits)]
                }
                None => removed.into_iter().flatten().collect(),
            };
            self.problems.retain(|problem| {
                if problem.primary.as_ref().is_some_and(|label| label.span == second.key_span) {
                    problem.clear_helps();
                    let told = ways.iter().cloned();
                    *problem = told.fold(problem.clone(), |problem, (text, edits)| problem.suggest(text, edits));
                    *problem = problem.clone().otherwise("the entries of both belong into one");
                }
                true
            });
        }
        fields
    }

    /// Writes the keys of a repeated mapping in the first one; `None` if that has one of them already.
    fn moved_up(&self, first: Field<'_>, second: Field<'_>) -> Option<Vec<Edit>> {
        let mut edits = vec![self.remove_entry(second)?];
        self.move_up(first.value, second.value, &mut edits)?;
        Some(edits)
    }

    fn move_up(&self, first: &Node, second: &Node, edits: &mut Vec<Edit>) -> Option<()> {
        let column = |entries: &[(Node, Node)]| Some(self.source.column(entries.first()?.0.span.start));
        let shift = (column(first.entries()?)?, column(second.entries()?)?);
        for (key, value) in second.entries()? {
            let name = key.text()?;
            let same = first.entries()?.iter().find(|(known, _)| known.text() == Some(name));
            match same.map(|(_, old)| old) {
                Some(old) if old.entries().is_some() && value.entries().is_some() => self.move_up(old, value, edits)?,
                Some(_) => return None,
                None => {
                    let entry = self.written(key.span.to(value.span));
                    let is_block = !self.is_flow(first) && !self.is_flow(second) && shift.0 == shift.1;
                    (is_block || !entry.contains('\n')).then_some(())?;
                    edits.push(self.add_last(first, entry)?);
                }
            }
        }
        Some(())
    }

    /// The keys of a mapping; those that are not `allowed` are reported.
    pub(super) fn keys<'n, 'k>(
        &mut self,
        entries: &'n [(Node, Node)],
        allowed: impl IntoIterator<Item = &'k Key>,
        owner: &str,
    ) -> Keys<'n, 'k> {
        let keys = Keys { fields: self.names(entries, owner), allowed: allowed.into_iter().collect() };
        self.check_keys(&keys, |_| false, &HashSet::new(), owner);
        keys
    }

    /// The entries of a key whose value is a mapping from names; none without the key.
    pub(super) fn named_entries<'n>(
        &mut self,
        keys: &Keys<'n, '_>,
        key: &str,
        advise: impl FnOnce(&Self, Diagnostic, Field<'n>) -> Diagnostic,
    ) -> Vec<Field<'n>> {
        let entries = keys.section(key).and_then(|field| {
            let message = format!("`{key}` is a mapping");
            self.entries(field, &message, |reader, problem| advise(reader, problem, field))
        });
        let Some((entries, field)) = entries.zip(keys.section(key)) else { return Vec::new() };
        let entries = self.own_entries(field, entries);
        self.names(entries, &format!("`{key}`")).list
    }
}

/// The keys that a mapping has, and the keys that it may have.
pub(super) struct Keys<'n, 'k> {
    pub(super) fields: Fields<'n>,
    pub(super) allowed: Vec<&'k Key>,
}

impl<'n> Keys<'n, '_> {
    pub(super) fn get(&self, key: &str) -> Option<Field<'n>> {
        self.fields.get(key)
    }

    /// The names in the mapping that is the value of a key.
    pub(super) fn names_of(&self, key: &str) -> Vec<String> {
        let entries = self.section(key).and_then(|field| field.value.entries()).into_iter().flatten();
        entries.filter_map(|(name, _)| name.text()).map(str::to_owned).collect()
    }

    /// Whether the mapping has the key, or may have it: misspelt, or in a part that could not be read. Both have been
    /// reported.
    pub(super) fn may_have(&self, key: &str) -> bool {
        let means_it = |field: &Field<'_>| likely_key(field.key, &self.allowed) == Some(key);
        self.fields.damaged || self.get(key).is_some() || self.fields.list.iter().take(MOST_KEYS).any(means_it)
    }
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
