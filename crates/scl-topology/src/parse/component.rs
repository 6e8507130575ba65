//! The sections `components` and `kinds`.

use super::entry::Entry;
use super::field::{Field, Fields};
use super::topology_dialect::TOPOLOGY;
use super::words::{COMPONENT_KEYS, is_kind};
use super::{Reader, glued, pitfall, scalar, shape};
use crate::diagnostic::{Diagnostic, Edit};
use crate::grammar;
use crate::grammar::parameter::PARAMETERS;
use crate::model::ComponentModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    /// Reads the section `kinds`, whose items have the shape of components.
    pub(super) fn read_kinds(&mut self, section: Field<'_>) {
        if section.value.is_null() {
            return;
        }
        let components = std::mem::take(&mut self.model.components);
        let components_unread = std::mem::take(&mut self.model.components_unread);
        self.reads = Entry::Kind;
        self.read_components(section);
        self.reads = Entry::Component;
        self.model.kinds.append(&mut std::mem::replace(&mut self.model.components, components));
        self.model.kinds_unread |= std::mem::replace(&mut self.model.components_unread, components_unread);
    }

    pub(super) fn read_components(&mut self, section: Field<'_>) {
        match &section.value.kind {
            NodeKind::Unread => self.model.components_unread = true,
            NodeKind::Sequence { items } => items.iter().for_each(|item| self.read_component(item)),
            NodeKind::Mapping { entries } => self.read_components_by_name(section, entries),
            _ => {
                self.model.components_unread = true;
                let problem = match section.value.is_null() {
                    true => shape::missing::components(section, self.source),
                    false => self.glued_or(section.value, shape::section_kind::text(section)),
                };
                self.report(problem);
            }
        }
    }

    /// `components: {sensor: {gates: ...}}`: a mistake, but one that can be read.
    fn read_components_by_name(&mut self, section: Field<'_>, entries: &[(Node, Node)]) {
        let first = self.model.components.len();
        for field in self.fields(entries, &format!("`{}`", section.key)).list {
            let what = self.reads.name();
            let Some(name) = self.name(field.key_node, what, &format!("a {what}")) else { continue };
            match &field.value.kind {
                NodeKind::Mapping { entries } => {
                    let fields = self.fields(entries, &format!("this {}", self.reads.word()));
                    self.read_component_fields(&fields, name, field.key_span.to(field.value.span));
                }
                _ => self.model.components.push(unread_component(name)),
            }
        }
        let first = self.model.components.get(first);
        self.report(shape::section_kind::components(section, first, self.reads, self.source));
    }

    fn read_component(&mut self, item: &Node) {
        let NodeKind::Mapping { entries } = &item.kind else {
            if shape::stray_connection::is_pair(item) {
                return self.read_stray_connection(item);
            }
            self.model.components_unread = true;
            let problem = match item.kind {
                NodeKind::Unread => return,
                _ if item.is_null() => pitfall::no_value::in_list(item, "list item", self.source),
                _ => self.glued_or(item, shape::nameless::not_a_mapping(item, self.reads, self.source)),
            };
            return self.report(problem);
        };
        if let Some(second) = second_component(entries) {
            let (first, rest) = entries.split_at(second);
            self.read_component_entries(item, first);
            let start = rest.first().map_or(item.span.end, |(key, _)| key.span.start) as usize;
            let line = start..self.source.line_range(start).end;
            let problem = pitfall::dash::missing(&line, self.source.text(), self.source);
            let head = self.source.text()[..start].trim_end_matches(' ').len();
            let edits = match start - head > 1 {
                true => vec![Edit::new(self.source.span(start - 2..start), "- ")],
                false => vec![Edit::new(self.source.span(start..start), "- ")],
            };
            self.report(problem.carry(edits, false));
            return self.read_component_entries(item, rest);
        }
        self.read_component_entries(item, entries);
    }

    fn read_component_entries(&mut self, item: &Node, entries: &[(Node, Node)]) {
        if self.is_stray_gate(entries) {
            return self.read_stray_gate(item);
        }
        self.component = Some(item.span);
        let fields = self.fields(entries, &format!("this {}", self.reads.word()));
        let name = match fields.get("name") {
            Some(field) => self.name_in(field, self.reads.name()),
            None => {
                let misnamed = shape::unknown_key::misnamed(&fields);
                match misnamed {
                    Some(field) => self.report(shape::unknown_key::instead_of_name(field, self.reads)),
                    None => self.report_nameless(item, &fields),
                }
                misnamed.and_then(|field| scalar(field.value))
            }
        };
        match name {
            Some(name) => {
                let span = entries.iter().map(|(key, value)| key.span.to(value.span)).reduce(Span::to);
                self.read_component_fields(&fields, name, span.unwrap_or(item.span));
            }
            None => self.model.components_unread = true,
        }
    }

    /// Reads an item of another list if it is a component, and reports it.
    pub(super) fn read_stray_component(&mut self, list: &str, item: &Node, entries: &[(Node, Node)]) -> bool {
        let Some(name) = shape::level::component_name(entries) else { return false };
        let above = self.component;
        self.report(shape::level::component_among(list, item.span, name, above, self.reads, self.source));
        self.read_component_entries(item, entries);
        self.component = above;
        true
    }

    /// A pair in the list of components: the line `connections:` is missing, or stands elsewhere.
    fn read_stray_connection(&mut self, item: &Node) {
        if !self.has_stray_connections {
            self.report(shape::stray_connection::diagnose(item, self.source));
        }
        self.has_stray_connections = true;
        self.read_connection(item);
    }

    /// Whether a list item is rather a gate of the component above it.
    fn is_stray_gate(&self, entries: &[(Node, Node)]) -> bool {
        let [(key, value)] = entries else { return false };
        let is_name = scalar(key).is_some_and(|key| !COMPONENT_KEYS.contains(&key.value.as_str()));
        let is_kind = match &value.kind {
            NodeKind::Scalar { text, .. } => is_kind(text),
            NodeKind::Mapping { entries } => {
                entries.iter().any(|(key, _)| scalar(key).is_some_and(|key| is_kind(&key.value)))
            }
            _ => false,
        };
        is_name && is_kind && !self.model.components.is_empty()
    }

    fn read_stray_gate(&mut self, item: &Node) {
        let Some(mut component) = self.model.components.pop() else { return };
        self.report(shape::level::gate_among_components(item, &component, self.reads, self.source));
        self.read_gate_item(item, &mut component);
        self.model.components.push(component);
    }

    fn report_nameless(&mut self, item: &Node, fields: &Fields<'_>) {
        if fields.damaged {
            return;
        }
        let above = self.model.components.last();
        let problem = shape::level::gates_after_dash(item, fields, above, self.source)
            .unwrap_or_else(|| shape::nameless::diagnose(item, fields, self.reads, self.source));
        self.report(problem);
        if let Some(component) = self.model.components.last_mut() {
            component.gates_unread = true;
        }
    }

    fn read_component_fields(&mut self, fields: &Fields<'_>, name: Spanned<String>, span: Span) {
        let mut component = ComponentModel { span, ..unread_component(name) };
        component.gates_unread = fields.damaged;
        let mut has_kind = false;
        for field in &fields.list {
            match field.key {
                "name" => {}
                key if fields.get("name").is_none() && shape::unknown_key::is_misnamed(key) => {}
                "doc" => component.doc = self.text(*field),
                "optional" => component.optional = self.boolean(*field),
                grammar::MEMORY => component.memory = self.shaped(*field, grammar::MEMORY_SHAPE),
                key if key == grammar::KIND && self.reads == Entry::Component => {
                    component.kind = self.name_in(*field, "kind");
                    has_kind = true;
                }
                PARAMETERS => {
                    component.parameters_entry = Some(field.key_span.to(field.value.span));
                    component.parameters = self.read_parameters(*field);
                }
                "gates" => {
                    component.gates_entry = Some(field.key_span.to(field.value.span));
                    self.read_all_gates(fields, &mut component);
                }
                _ => self.read_unknown_key(*field, &mut component),
            }
        }
        let gates = fields.all("gates").last();
        if has_kind {
            component.gates_unread |= component.kind.is_none();
        } else if component.gates.is_empty() && !component.gates_unread {
            self.problems.extend(shape::missing::find_gates(&component.name, gates, self.reads, self.source));
        }
        self.model.components.push(component);
    }

    /// Reads the gates, also those of a repeated list. If two lists have gates in them, the second one belongs to a
    /// component that has lost its name, so only the first is read.
    fn read_all_gates(&mut self, fields: &Fields<'_>, component: &mut ComponentModel) {
        let has_items =
            |gates: &Field<'_>| matches!(&gates.value.kind, NodeKind::Sequence { items } if !items.is_empty());
        let is_two = fields.all("gates").filter(has_items).count() > 1;
        self.model.components_unread |= is_two;
        component.gates_unread |= is_two;
        let read = if is_two { 1 } else { usize::MAX };
        fields
            .all("gates")
            .filter(|gates| !is_two || has_items(gates))
            .take(read)
            .for_each(|gates| self.read_gates(gates, component));
    }

    fn read_unknown_key(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        component.gates_unread = true;
        if field.key == "connections" {
            self.has_stray_connections = true;
            self.read_connections(field);
        }
        self.model.components_unread |= field.key == "components";
        let (owner, last) = (&component.name.value, self.last_connection);
        let problem = shape::level::in_component(field, owner, self.reads, self.source)
            .unwrap_or_else(|| shape::unknown_key::of_component(field, owner, self.reads, last, self.source));
        self.report(problem);
    }

    /// Reads a paragraph for the documentation.
    pub(super) fn text(&mut self, field: Field<'_>) -> Option<Spanned<String>> {
        match &field.value.kind {
            NodeKind::Unread => None,
            _ if super::name::is_empty(field.value) => {
                self.report(pitfall::no_value::in_field(field, &format!("text of `{}`", field.key), self.source));
                None
            }
            NodeKind::Scalar { .. } => {
                self.problems.extend(pitfall::cut_off::find(field.value, self.source));
                scalar(field.value)
            }
            _ => {
                let problem = shape::option_value::not_text(&format!("`{}`", field.key), field.value);
                self.report(pitfall::cut_off::as_text(problem, field.value.span, self.source));
                None
            }
        }
    }

    /// Returns the problem that explains why a list or mapping is missing, or else `otherwise`.
    pub(super) fn glued_or(&self, node: &Node, otherwise: Diagnostic) -> Diagnostic {
        glued(node, self.source, &TOPOLOGY).unwrap_or(otherwise)
    }
}

/// Returns where a second component starts among the keys of one: at a second `name`, if other keys are repeated too.
fn second_component(entries: &[(Node, Node)]) -> Option<usize> {
    let keys: Vec<Option<String>> = entries.iter().map(|(key, _)| scalar(key).map(|key| key.value)).collect();
    let is_name = |key: &Option<String>| key.as_deref() == Some("name");
    let second = keys.iter().enumerate().filter(|(_, key)| is_name(key)).nth(1)?.0;
    let comes_again = |key: &Option<String>| !is_name(key) && key.is_some() && keys[..second].contains(key);
    keys[second..].iter().any(comes_again).then_some(second)
}

pub(super) fn unread_component(name: Spanned<String>) -> ComponentModel {
    let span = name.span;
    ComponentModel {
        name,
        doc: None,
        optional: None,
        memory: None,
        kind: None,
        of: None,
        parameters: Vec::new(),
        parameters_entry: None,
        gates: Vec::new(),
        gates_entry: None,
        group: 0,
        gates_unread: true,
        span,
    }
}
