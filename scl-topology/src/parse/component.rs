//! The section `components`.

use super::fields::{Field, Fields};
use super::sections::spanned_key;
use super::{Reader, pitfall, scalar, shape};
use crate::grammar;
use crate::model::ComponentModel;
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind};

/// The keys of a component, in the order in which messages list them.
pub(super) const KEYS: [&str; grammar::COMPONENT_KEYS.len()] = grammar::words(&grammar::COMPONENT_KEYS);

impl Reader<'_> {
    pub(super) fn read_components(&mut self, section: Field<'_>) {
        match &section.value.kind {
            NodeKind::Unread => self.model.components_unread = true,
            NodeKind::Sequence { items } => items.iter().for_each(|item| self.read_component(item)),
            NodeKind::Mapping { entries } => self.read_components_by_name(section, entries),
            _ => {
                self.model.components_unread = true;
                let problem = match section.value.is_null() {
                    true => shape::no_components::diagnose(section),
                    false => self.glued_or(section.value, shape::section_kind::text(section)),
                };
                self.report(problem);
            }
        }
    }

    /// `components: {sensor: {gates: ...}}`: a mistake, but one that can be read.
    fn read_components_by_name(&mut self, section: Field<'_>, entries: &[(Node, Node)]) {
        let first = self.model.components.len();
        for field in self.fields(entries, "`components`").list {
            let Some(name) = self.name(field.key_node, "component name", "a component name") else { continue };
            match &field.value.kind {
                NodeKind::Mapping { entries } => {
                    let fields = self.fields(entries, "this component");
                    self.read_component_fields(&fields, name);
                }
                _ => self.model.components.push(unread_component(name)),
            }
        }
        let problem = shape::section_kind::components(section, self.model.components.get(first));
        self.report(problem);
    }

    fn read_component(&mut self, item: &Node) {
        let NodeKind::Mapping { entries } = &item.kind else {
            self.model.components_unread = true;
            let problem = match item.kind {
                NodeKind::Unread => return,
                _ if item.is_null() => pitfall::no_value::in_list(item, "list item", self.source),
                _ => self.glued_or(item, shape::nameless::not_a_mapping(item)),
            };
            return self.report(problem);
        };
        let fields = self.fields(entries, "this component");
        let name = match fields.get("name") {
            Some(field) => self.name_in(field, "component name"),
            None => {
                self.report_nameless(item, &fields);
                None
            }
        };
        match name {
            Some(name) => self.read_component_fields(&fields, name),
            None => self.model.components_unread = true,
        }
    }

    fn report_nameless(&mut self, item: &Node, fields: &Fields<'_>) {
        if fields.damaged {
            return;
        }
        let above = self.model.components.last();
        let problem = shape::level::gates_after_dash(item, fields, above, self.source)
            .unwrap_or_else(|| shape::nameless::diagnose(item, fields, self.source));
        self.report(problem);
        if let Some(component) = self.model.components.last_mut() {
            component.gates_unread = true;
        }
    }

    fn read_component_fields(&mut self, fields: &Fields<'_>, name: Spanned<String>) {
        let mut component = unread_component(name);
        component.gates_unread = fields.damaged;
        for field in &fields.list {
            match field.key {
                "name" => {}
                "doc" => component.doc = self.text(*field),
                "optional" => component.optional = self.boolean(*field).unwrap_or(false),
                "gates" => self.read_gates(*field, &mut component),
                _ => self.read_unknown_key(*field, &mut component),
            }
        }
        let gates = fields.get("gates");
        if component.gates.is_empty() && !component.gates_unread {
            self.problems.extend(shape::gateless::find(&component.name, gates));
        }
        self.model.components.push(component);
    }

    fn read_unknown_key(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        component.gates_unread = true;
        if field.key == "connections" {
            self.remember_broken_ends(field.value);
            self.model.broken_ends.push(spanned_key(field));
        }
        let owner = &component.name.value;
        let problem = shape::level::in_component(field, owner, self.source)
            .unwrap_or_else(|| shape::component_key::diagnose(field, owner));
        self.report(problem);
    }

    /// A paragraph for the documentation.
    pub(super) fn text(&mut self, field: Field<'_>) -> Option<Spanned<String>> {
        match &field.value.kind {
            NodeKind::Unread => None,
            _ if super::name::is_empty(field.value) => {
                self.report(pitfall::no_value::in_field(field, &format!("text of `{}`", field.key), self.source));
                None
            }
            NodeKind::Scalar { .. } => scalar(field.value),
            _ => {
                self.report(shape::option_value::not_text(&format!("`{}`", field.key), field.value));
                None
            }
        }
    }

    /// The problem of a missing space after `:` if that explains why a mapping is missing, else `otherwise`.
    pub(super) fn glued_or(
        &self,
        node: &Node,
        otherwise: crate::diagnostic::Diagnostic,
    ) -> crate::diagnostic::Diagnostic {
        pitfall::missing_space::in_node(node, self.source).unwrap_or(otherwise)
    }
}

fn unread_component(name: Spanned<String>) -> ComponentModel {
    ComponentModel { name, doc: None, optional: false, gates: Vec::new(), gates_unread: true }
}

/// From the first character of an item, its `-` included, to the end of its first key.
pub(super) fn head(item: &Node, fields: &Fields<'_>, source: &crate::source::SourceFile) -> Span {
    let start = super::with_dash(item.span, source);
    match fields.list.first() {
        Some(first) => Span { end: first.key_span.end, ..start },
        None => start,
    }
}

/// The end of a key, its colon included if it follows at once.
pub(super) fn end_with_colon(key: Span, source: &crate::source::SourceFile) -> u32 {
    let follows = source.text().get(key.end as usize..).is_some_and(|rest| rest.starts_with(':'));
    key.end + u32::from(follows)
}
