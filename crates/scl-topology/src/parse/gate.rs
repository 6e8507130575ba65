//! The gates of a component.

use super::field::{Field, Fields, spanned_key};
use super::topology_dialect::TOPOLOGY;
use super::words::{is_kind, is_like_option, is_option};
use super::{Reader, pitfall, scalar, shape};
use crate::confusable;
use crate::diagnostic::Diagnostic;
use crate::model::{ComponentModel, GateModel};
use crate::source::{Span, Spanned};
use crate::yaml::{Node, NodeKind};

impl Reader<'_> {
    pub(super) fn read_gates(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        match &field.value.kind {
            NodeKind::Unread => component.gates_unread = true,
            NodeKind::Sequence { items } => items.iter().for_each(|item| self.read_gate_item(item, component)),
            NodeKind::Mapping { entries } if is_glued_dash(entries) => {
                component.gates_unread = true;
                self.report(self.dash_without_space(field.value.span));
            }
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
            // A component without gates gets its own warning.
            _ if field.value.is_null() => {}
            _ => {
                component.gates_unread = true;
                self.report(self.glued_or(field.value, shape::section_kind::text(field)));
            }
        }
    }

    pub(super) fn read_gate_item(&mut self, item: &Node, component: &mut ComponentModel) {
        let NodeKind::Mapping { entries } = &item.kind else { return self.read_bare_item(item, component) };
        let fields = self.fields(entries, "this gate");
        component.gates_unread |= fields.damaged;
        if let Some([name, kind]) = shape::gate::long_form(&fields) {
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
        if first.value.is_null()
            && let Some(kind) = others.clone().find(|other| is_kind(other.key))
            && let Some(name) = self.name(first.key_node, "gate name", "a gate name")
        {
            self.report(shape::level::kind_beside_name(*kind, *first, self.source));
            let whole = Field { value: item, ..*first };
            let gate = self.read_gate_mapping(name, whole, entries.get(1..).unwrap_or(&[]), &component.name.value);
            return component.gates.push(gate);
        }
        self.read_gate(*first, component);
        let (options, gates): (Vec<&Field<'_>>, Vec<&Field<'_>>) = others.partition(|other| is_option(other.key));
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
            NodeKind::Scalar { text, .. } => match pitfall::missing_space::in_node(item, self.source, &TOPOLOGY) {
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
        let span = item.span;
        let word = |word: &str| Spanned { value: word.to_owned(), span };
        let start = |name: &str| Spanned { span: Span { end: span.start + name.len() as u32, ..span }, ..word(name) };
        let with_kind = |separator| {
            let (name, kind) = text.split_once(separator)?;
            is_kind(kind.trim()).then(|| (name, kind.trim()))
        };
        let look_alike = pitfall::look_alike::in_word(item, text, "gate name", self.source);
        let (gate, problem) = if let Some(problem) = look_alike {
            let retyped = confusable::retyped(text);
            let (name, kind) = retyped.split_once([':', ' ']).unwrap_or((&retyped, ""));
            let kind = if is_kind(kind.trim()) { kind.trim() } else { "" };
            (bare_gate(word(name.trim_matches(['"', '\''])), word(kind), span), problem)
        } else if let Some((name, kind)) = with_kind('=') {
            let name = name.trim();
            (bare_gate(start(name), word(kind), span), shape::gate::equals_sign(name, kind, span))
        } else if let Some((name, kind)) = with_kind(' ').filter(|_| item.is_plain()) {
            (bare_gate(start(name), word(kind), span), shape::gate::without_colon(name, kind, span))
        } else {
            (unread_gate(word(text)), shape::gate::without_kind(text, span))
        };
        component.gates.push(gate);
        problem
    }

    /// `name: kind` or `name: {kind: type, option: value}`.
    fn read_gate(&mut self, field: Field<'_>, component: &mut ComponentModel) {
        if let Some((name, rest)) = field.key.split_once(" {").filter(|_| field.key_node.is_plain()) {
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
                    let kind = self.in_ascii(field.value, kind, "the kind");
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
        if let Some(problem) = self.look_alike_key(&fields) {
            self.report(problem);
            return gate;
        }
        if let Some(glued) = glued_key(&fields) {
            self.report(shape::gate::key_without_colon(glued, first_word(glued.key)));
            return gate;
        }
        let Some(kind) = self.gate_kind(field, &fields) else { return gate };
        gate.kind = spanned_key(kind);
        gate.payload = self.payload(kind);
        if let Some(answer) = self.second_type(kind, &fields) {
            if let Some(payload) = &mut gate.payload {
                payload.value = format!("{} -> {}", payload.value, answer.key);
            }
            self.report(shape::gate::comma_between_types(&gate, answer));
            return gate;
        }
        let path = format!("{owner}.{}", gate.name.value);
        let rest_of_doc = rest_of_doc(&fields);
        if let (Some(doc), [first, .., last] | [first @ last]) = (fields.get("doc"), rest_of_doc) {
            let text = doc.value.span.to(last.key_span);
            self.report(shape::unknown_key::comma_in_doc(first.key_span, text, self.source, &path));
        }
        let is_rest = |field: &Field<'_>| rest_of_doc.iter().any(|rest| rest.key_span == field.key_span);
        for option in fields.list.iter().filter(|field| field.key_span != kind.key_span && !is_rest(field)) {
            if is_option(option.key) {
                gate.options.extend(self.option(*option));
            } else if !is_kind(option.key) {
                self.report(shape::unknown_key::of_gate(*option, kind.key, &path));
            }
        }
        gate
    }

    /// A key without a value that has a look-alike in it, such as another colon.
    fn look_alike_key(&self, fields: &Fields<'_>) -> Option<Diagnostic> {
        let mut empty = fields.list.iter().filter(|field| field.value.is_null() && !field.key.is_ascii());
        empty.find_map(|field| pitfall::look_alike::in_word(field.key_node, field.key, "the key", self.source))
    }

    /// `{rep: Request, Reply}`: the second type of an exchange, as a key.
    fn second_type<'n>(&self, kind: Field<'_>, fields: &Fields<'n>) -> Option<Field<'n>> {
        let asks = matches!(kind.key, "req" | "rep");
        let has_one = scalar(kind.value).is_some_and(|payload| !payload.value.contains("->"));
        let is_type = |key: &str| key.chars().next().is_some_and(char::is_uppercase) || key.contains('.');
        let second = |field: &&Field<'_>| field.value.is_null() && is_type(field.key);
        fields.list.iter().find(second).filter(|_| asks && has_one).copied()
    }

    /// The key that names the kind: one of the six words, or else the first that is no option.
    fn gate_kind<'n>(&mut self, gate: Field<'_>, fields: &Fields<'n>) -> Option<Field<'n>> {
        let kinds: Vec<_> = fields.list.iter().copied().filter(|field| is_kind(field.key)).collect();
        if let [first, second, ..] = kinds.as_slice() {
            self.report(shape::gate::two_kinds(gate.key, first, second));
        }
        let unknown = || fields.list.iter().copied().find(|field| !is_like_option(field.key));
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
        let mut payload = self.name_in(kind, &format!("type of the `{}` gate", kind.key))?;
        if matches!(kind.key, "req" | "rep")
            && let Some((arrow, meant)) = odd_arrow(&payload.value)
        {
            self.report(shape::gate::odd_arrow(kind, arrow, &meant));
            payload.value = meant;
        }
        // Quotes do not change a type; the span includes them.
        (kind.value.is_plain() || !payload.value.trim().is_empty()).then_some(payload)
    }
}

/// `{pub: Type, doc: One, two}`: the keys after the first comma of a text without quotes.
fn rest_of_doc<'f, 'n>(fields: &'f Fields<'n>) -> &'f [Field<'n>] {
    let is_doc = |field: &Field<'_>| field.key == "doc" && field.value.is_plain() && !field.value.is_null();
    let Some(doc) = fields.list.iter().position(is_doc) else { return &[] };
    let rest = &fields.list[doc + 1..];
    let is_option = |field: &Field<'_>| is_kind(field.key) || is_option(field.key);
    let is_text = |field: &Field<'_>| field.value.is_null() && field.key_node.is_plain() && !is_option(field);
    &rest[..rest.iter().take_while(|field| is_text(field)).count()]
}

/// `{pub Type, queue 4}`: a key that lacks its colon, so that its value belongs to it.
fn glued_key<'n>(fields: &Fields<'n>) -> Option<Field<'n>> {
    let is_glued = |field: &&Field<'n>| {
        let word = first_word(field.key);
        let is_known = is_kind(word) || is_option(word);
        field.value.is_null() && word.len() < field.key.len() && is_known && field.key_node.is_plain()
    };
    fields.list.iter().find(is_glued).copied()
}

/// The word up to a space or an equals sign.
fn first_word(key: &str) -> &str {
    key.split([' ', '=']).next().unwrap_or(key)
}

/// Whether each entry is an item of a list whose dash lacks its space: `-measurements: pub`.
fn is_glued_dash(entries: &[(Node, Node)]) -> bool {
    let is_glued = |key: &Node| {
        key.is_plain() && scalar(key).is_some_and(|key| key.value.starts_with('-') && !key.value.starts_with("--"))
    };
    !entries.is_empty() && entries.iter().all(|(key, _)| is_glued(key))
}

/// Something between two types that stands for `->`, and the text with `->` in its place.
fn odd_arrow(payload: &str) -> Option<(&str, String)> {
    let words: Vec<&str> = payload.split_whitespace().collect();
    let is_type = |word: &str| word.starts_with(|c: char| c.is_ascii_alphabetic()) && !word.contains(['>', '<']);
    let (first, last) = (words.first()?, words.last()?);
    let glued = ["=>", "-->"].into_iter().find_map(|arrow| {
        let (request, reply) = payload.split_once(arrow)?;
        Some((arrow, request.trim(), reply.trim()))
    });
    match (words.as_slice(), glued) {
        (_, Some((arrow, request, reply))) if is_type(request) && is_type(reply) => {
            Some((arrow, format!("{request} -> {reply}")))
        }
        ([request, reply], None) if is_type(request) && is_type(reply) => Some(("", format!("{request} -> {reply}"))),
        ([_, .., _], None) if is_type(first) && is_type(last) => {
            let between = payload[first.len()..payload.len() - last.len()].trim();
            let is_arrow = matches!(between, "<-" | "-" | ">" | "- >" | "→" | "<->" | "--" | "=" | ":" | "/" | "|");
            is_arrow.then(|| (between, format!("{first} -> {last}")))
        }
        _ => None,
    }
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
