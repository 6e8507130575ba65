//! The gates of a component.

use super::fields::{Field, Fields};
use super::{Reader, is_plain, pitfall, scalar, shape};
use crate::diagnostic::Diagnostic;
use crate::model::{ComponentModel, GateModel};
use crate::source::{Span, Spanned};
use crate::topology::GateKind;
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    pub(super) fn read_gates(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        match &field.value.kind {
            NodeKind::Unread => component.gates_unread = true,
            NodeKind::Sequence { items } => items.iter().for_each(|item| self.read_gate_item(item, component)),
            NodeKind::Mapping { entries } => {
                self.report(shape::section_kind::gates(field, self.source));
                for gate in self.fields(entries, "`gates`").list {
                    // `-- x: pub` is a key with a dash in it, not a gate with an odd name.
                    if gate.key.starts_with('-') {
                        component.gates_unread = true;
                        continue;
                    }
                    self.read_gate(gate, component);
                }
            }
            // A component without gates is a warning of its own.
            _ if field.value.is_null() => {}
            _ => {
                component.gates_unread = true;
                let problem = self.glued_or(field.value, shape::section_kind::text(field));
                self.report(problem);
            }
        }
    }

    fn read_gate_item(&mut self, item: &Node, component: &mut ComponentModel) {
        let NodeKind::Mapping { entries } = &item.kind else { return self.read_bare_item(item, component) };
        let fields = self.fields(entries, "this gate");
        component.gates_unread |= fields.damaged;
        if let Some((name, kind)) = shape::gate::long_form(&fields) {
            self.report(shape::gate::written_long(item, &fields));
            let span = item.span;
            return component.gates.extend(name.zip(kind).map(|(name, kind)| bare_gate(name, kind, span)));
        }
        let mut others = fields.list.iter();
        let Some(first) = others.next() else {
            if !fields.damaged {
                component.gates_unread = true;
                self.report(shape::gate::empty_mapping(item));
            }
            return;
        };
        self.read_gate(*first, component);
        let (options, gates): (Vec<&Field<'_>>, Vec<&Field<'_>>) =
            others.partition(|other| super::option::is_key(other.key));
        for option in options {
            self.report(shape::level::option_beside_gate(*option, *first, self.source));
        }
        if !gates.is_empty() {
            self.report(shape::gate::several_in_one_item(*first, &gates));
        }
        gates.into_iter().for_each(|gate| self.read_gate(*gate, component));
    }

    /// A list item that is no mapping: a name without a kind, or `name:kind`.
    fn read_bare_item(&mut self, item: &Node, component: &mut ComponentModel) {
        let problem = match &item.kind {
            NodeKind::Unread => {
                component.gates_unread = true;
                return;
            }
            NodeKind::Scalar { .. } if item.is_null() => pitfall::no_value::in_list(item, "list item", self.source),
            NodeKind::Scalar { text, .. } => match pitfall::missing_space::in_node(item, self.source) {
                Some(problem) => {
                    let name = text.split(':').next().unwrap_or(text).to_owned();
                    component.gates.push(unread_gate(Spanned { value: name, span: item.span }));
                    problem
                }
                None => self.read_gate_without_colon(item, text, component),
            },
            _ => shape::gate::is_list(item),
        };
        component.gates_unread |= !matches!(item.kind, NodeKind::Scalar { .. }) || item.is_null();
        self.report(problem);
    }

    /// `- name`, or `- name kind`, which can be understood.
    fn read_gate_without_colon(&mut self, item: &Node, text: &str, component: &mut ComponentModel) -> Diagnostic {
        let named = |name: &str| Spanned {
            value: name.to_owned(),
            span: Span { end: item.span.start + name.len() as u32, ..item.span },
        };
        match text.split_once(' ').filter(|(_, kind)| is_kind(kind.trim())) {
            Some((name, kind)) if is_plain(item) => {
                component.gates.push(bare_gate(
                    named(name),
                    Spanned { value: kind.trim().to_owned(), span: item.span },
                    item.span,
                ));
                shape::gate::without_colon(name, kind.trim(), item.span)
            }
            _ => {
                component.gates.push(unread_gate(Spanned { value: text.to_owned(), span: item.span }));
                shape::gate::without_kind(text, item.span)
            }
        }
    }

    /// `name: kind` or `name: {kind: type, option: value}`.
    fn read_gate(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        if let Some((name, rest)) = field.key.split_once(" {").filter(|_| is_plain(field.key_node)) {
            self.report(shape::gate::without_colon(name, &format!("{{{rest}: ...}}"), field.key_span));
            let span = Span { end: field.key_span.start + name.len() as u32, ..field.key_span };
            return component.gates.push(unread_gate(Spanned { value: name.to_owned(), span }));
        }
        let Some(name) = self.name(field.key_node, "gate name", "a gate name") else {
            component.gates_unread = true;
            return;
        };
        let owner = &component.name.value;
        let gate = match &field.value.kind {
            NodeKind::Mapping { entries } => self.read_gate_mapping(name, field, entries, owner),
            _ => self.read_short_gate(name, field),
        };
        component.gates.push(gate);
    }

    fn read_short_gate(&mut self, name: Spanned<String>, field: Field<'_>) -> GateModel {
        let span = field.key_span.to(field.value.span);
        let problem = match &field.value.kind {
            NodeKind::Unread => return unread_gate(name),
            NodeKind::Scalar { .. } if super::name::is_empty(field.value) => {
                shape::gate::without_kind(field.key, field.key_span)
            }
            NodeKind::Scalar { text, .. } => match shape::gate::kind_and_type(field, text) {
                Some(problem) => problem,
                None => {
                    let kind = scalar(field.value).unwrap_or(Spanned { value: text.clone(), span: field.value.span });
                    return bare_gate(name, kind, span);
                }
            },
            _ => shape::gate::kind_is_list(field),
        };
        self.report(problem);
        unread_gate(name)
    }

    fn read_gate_mapping(
        &mut self,
        name: Spanned<String>,
        field: Field<'_>,
        entries: &[(Node, Node)],
        owner: &str,
    ) -> GateModel {
        let fields = self.fields(entries, "this gate");
        let mut gate = unread_gate(name);
        gate.span = field.key_span.to(field.value.span);
        let Some(kind) = self.gate_kind(field, &fields) else { return gate };
        gate.kind = super::sections::spanned_key(kind);
        gate.payload = self.payload(kind);
        for option in fields.list.iter().filter(|other| other.key_span != kind.key_span) {
            if super::option::is_key(option.key) {
                gate.options.extend(self.option(*option));
            } else if !is_kind(option.key) {
                let path = format!("{owner}.{}", gate.name.value);
                self.report(shape::gate_key::diagnose(*option, kind.key, &path));
            }
        }
        gate
    }

    /// The key that says the kind: one of the six words, else the first that is no option.
    fn gate_kind<'n>(&mut self, gate: Field<'_>, fields: &Fields<'n>) -> Option<Field<'n>> {
        let kinds: Vec<_> = fields.list.iter().copied().filter(|field| is_kind(field.key)).collect();
        if let [first, second, ..] = kinds.as_slice() {
            self.report(shape::gate::two_kinds(gate.key, first, second));
        }
        let unknown = || fields.list.iter().copied().find(|field| !super::option::is_like(field.key));
        let kind = kinds.first().copied().or_else(unknown);
        if kind.is_none() && !fields.damaged {
            self.report(shape::gate::without_kind_key(gate, fields));
        }
        if let Some(problem) = kind.and_then(|_| shape::gate::kind_as_key(gate, fields)) {
            self.report(problem);
            return None;
        }
        kind
    }

    /// The type; none where the kind stands without a value, as in `{pub: , queue: 1}`: an untyped gate with options.
    fn payload(&mut self, kind: Field<'_>) -> Option<Spanned<String>> {
        if kind.value.is_null() {
            return None;
        }
        let payload = self.name_in(kind, &format!("type of the `{}` gate", kind.key))?;
        // A type in quotes is the same type; the place is that of the whole value.
        (is_plain(kind.value) || !payload.value.trim().is_empty()).then_some(payload)
    }
}

pub(super) fn is_kind(word: &str) -> bool {
    GateKind::of(word).is_some()
}

fn bare_gate(name: Spanned<String>, kind: Spanned<String>, span: Span) -> GateModel {
    GateModel { name, kind, payload: None, options: Vec::new(), span }
}

/// A gate of which only the name is known.
fn unread_gate(name: Spanned<String>) -> GateModel {
    let span = name.span;
    let nothing = Spanned { value: String::new(), span: Span { start: span.end, ..span } };
    bare_gate(name, nothing, span)
}
