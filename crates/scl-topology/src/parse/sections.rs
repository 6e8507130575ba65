//! Reads the top level: which sections exist, and the content of the small ones.

use super::field::{Field, Fields};
use super::words::SECTIONS;
use super::{Part, Reader, shape};
use crate::grammar;
use crate::habits;
use crate::source::Spanned;
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    pub(super) fn read_sections(&mut self, entries: &[(Node, Node)]) {
        let fields = self.fields(entries, "this file");
        let connections = fields.get("connections").and_then(|section| section.value.items());
        self.last_connection = connections.and_then(<[Node]>::last).map(|last| last.span);
        for field in &fields.list {
            match field.key {
                "system" => self.model.system = self.name_in(*field, "system name"),
                "codec" => self.model.codec = self.name_in(*field, "codec"),
                grammar::INCLUDE => self.model.include = self.read_includes(*field),
                grammar::EXPORTS => self.read_exports(*field),
                "schemas" => self.model.schemas = self.read_files(*field, "schema file", "a schema"),
                "schema_roots" => {
                    self.model.schema_roots = self.read_files(*field, "folder of schemas", "a folder of schemas");
                }
                "scl" => self.problems.extend(shape::version::find(*field, self.source)),
                "components" | "connections" | "kinds" | grammar::EVERYONE => self.read_lists(&fields, field.key),
                key if key.starts_with(grammar::OWN_PREFIX) => self.check_extension(*field),
                _ => self.report_unknown_section(*field),
            }
        }
        self.check_missing_sections(&fields);
    }

    /// A section that is a list, and its repetitions. Of two lists with entries in them, only the first is read: if the
    /// second is a copy, everything in it would be a repetition too.
    fn read_lists(&mut self, fields: &Fields<'_>, key: &str) {
        let has_items = |section: &Field<'_>| match &section.value.kind {
            NodeKind::Sequence { items } => !items.is_empty(),
            _ => !section.value.is_null(),
        };
        let is_any = fields.all(key).any(|section| has_items(&section));
        let read = fields.all(key).filter(|section| !is_any || has_items(section));
        for (number, section) in read.enumerate() {
            match key {
                "components" if number > 0 => self.model.components_unread = true,
                "kinds" if number > 0 => self.model.kinds_unread = true,
                // The names in it are broken, and everything else in the file is sound without it.
                grammar::EVERYONE if number > 0 => {}
                grammar::EVERYONE => self.read_everyone(section),
                "connections" if number > 0 => self.remember_broken_ends(section.value),
                "components" => self.read_components(section),
                "kinds" => self.read_kinds(section),
                _ => self.read_connections(section),
            }
        }
    }

    pub(super) fn read_files(&mut self, field: Field<'_>, what: &str, one: &str) -> Vec<Spanned<String>> {
        match &field.value.kind {
            NodeKind::Unread => Vec::new(),
            NodeKind::Sequence { items } => items.iter().filter_map(|item| self.name(item, what, one)).collect(),
            _ if super::name::is_empty(field.value) => self.name_in(field, "list of files").into_iter().collect(),
            _ => {
                self.report(shape::section_kind::files(field));
                super::scalar(field.value).into_iter().collect()
            }
        }
    }

    fn report_unknown_section(&mut self, field: Field<'_>) {
        if field.key == "gates"
            && let Some(component) = self.model.components.last_mut()
        {
            // These are probably the gates of the component above.
            component.gates_unread = true;
            let name = component.name.span;
            self.problems.retain(|found| {
                *found.rule != shape::missing::GATES || found.primary.as_ref().is_none_or(|label| label.span != name)
            });
        }
        self.model.components_unread |= shape::unknown_key::is_include(field);
        self.report(
            shape::level::at_top(field, self.model.components.last(), self.source)
                .unwrap_or_else(|| shape::unknown_key::section(field, self.source)),
        );
    }

    fn check_missing_sections(&mut self, fields: &Fields<'_>) {
        let perhaps = |section: &str| fields.damaged || fields.list.iter().any(|field| is_misspelt(field.key, section));
        let is_odd_list = |field: &Field<'_>| {
            !SECTIONS.contains(&field.key)
                && !field.key.starts_with(grammar::OWN_PREFIX)
                && matches!(field.value.kind, NodeKind::Sequence { .. })
        };
        let has_connections = fields.get("connections").is_some();
        let is_stray = self.has_stray_connections;
        if let Some(section) = fields.get("connections").filter(|_| is_stray) {
            self.problems.retain(|problem| shape::stray_connection::with_section(problem, section, self.source));
        }
        let connections_unread =
            !has_connections && !is_stray && (perhaps("connections") || fields.list.iter().any(is_odd_list));
        self.model.connections_unread = connections_unread;
        self.model.kinds_unread |=
            fields.get("kinds").is_none() && (perhaps("kinds") || fields.list.iter().any(is_odd_list));
        // Another file may have the rest.
        let is_whole = self.part == Part::Main && fields.get(grammar::INCLUDE).is_none();
        match fields.get("components") {
            None if perhaps("components") => self.model.components_unread = true,
            _ if !is_whole => {}
            None => {
                self.model.components_unread = true;
                self.report(shape::missing::section(fields, self.source));
            }
            // The gates of `everyone` are connected without it.
            Some(_) if fields.get(grammar::EVERYONE).is_some() => {}
            Some(components) if !connections_unread && !is_stray && self.model.broken_ends.is_empty() => {
                let gates: usize = self.model.components.iter().map(|component| component.gates.len()).sum();
                let connections = fields.all("connections").last();
                self.problems.extend(shape::missing::find_connections(components, connections, gates, self.source));
            }
            Some(_) => {}
        }
    }
}

/// Whether an unknown key was probably meant to be this section.
fn is_misspelt(key: &str, section: &str) -> bool {
    let is_called = || habits::SECTIONS.find(key).is_some_and(|habit| habit.ways == [section]);
    !SECTIONS.contains(&key) && (is_called() || similar(key, [section]).contains(&section))
}
