//! The gates of a component.

mod cut;

use super::exchange::odd_arrow;
use super::field::{Field, Fields, spanned_key};
use super::topology_dialect::TOPOLOGY;
use super::words::{is_kind, is_like_option, is_option};
use super::{Reader, pitfall, scalar, shape};
use crate::confusable;
use crate::diagnostic::Diagnostic;
use crate::grammar::GateKind;
use crate::habits;
use crate::model::{ComponentModel, GateModel};
use crate::source::{SourceFile, Span, Spanned};
use crate::yaml::{Node, NodeKind};
use cut::{cut_numbers, glued_keys, is_in, rest_of_doc, rest_of_type, second_type};

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
                self.report(shape::section_kind::items(field, "gate", self.source));
                for gate in self.fields(entries, "`gates`").list {
                    // `-- x: pub` is a key with a dash in it, not a gate with an odd name.
                    if gate.key.starts_with('-') {
                        component.gates_unread = true;
                        continue;
                    }
                    if !self.read_nameless(&[gate], gate.key_span.to(gate.value.span), component) {
                        self.read_gate(gate, component);
                    }
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
        if self.read_stray_component("gates", item, entries) {
            return;
        }
        let fields = self.fields(entries, "this gate");
        component.gates_unread |= fields.damaged;
        if let Some([name, kind]) = shape::long_gate::parts(&fields) {
            self.report(shape::long_gate::diagnose(item, &fields, self.source));
            let gate = name.zip(kind).map(|(name, kind)| bare_gate(name, kind, item.span));
            return component.gates.extend(gate.map(|gate| self.read_long_gate(gate, &fields)));
        }
        let flow = self.source.snippet(item.span).starts_with('{').then_some(item.span);
        let block = || Some(fields.list.first()?.key_span.to(fields.list.last()?.value.span));
        if flow.or_else(block).is_some_and(|at| self.read_nameless(&fields.list, at, component)) {
            return;
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
            self.report(shape::level::kind_beside_name(*kind, *first, item.span, self.source));
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
            self.report(shape::gate::several_in_one_item(*first, &gates, self.source));
        }
        gates.into_iter().for_each(|gate| self.read_gate(*gate, component));
    }

    /// Reports a gate without a name; false if it has one.
    fn read_nameless(&mut self, fields: &[Field<'_>], at: Span, component: &mut ComponentModel) -> bool {
        if !shape::nameless_gate::is_nameless(fields) {
            return false;
        }
        component.gates_unread = true;
        self.problems.extend(shape::nameless_gate::diagnose(fields, at, self.source));
        true
    }

    /// `{name: measurements, kind: pub, type: Fix, queue: 4}`: type and options.
    fn read_long_gate(&mut self, mut gate: GateModel, fields: &Fields<'_>) -> GateModel {
        let is_type = |field: &&Field<'_>| habits::GATE.find(field.key).is_some_and(|habit| habit.is_type());
        let of_type = fields.list.iter().filter(|_| !gate.kind.value.is_empty() && fields.get("kind").is_some());
        let of_type = of_type.clone().find(is_type);
        gate.payload = of_type.and_then(|field| scalar(field.value));
        for option in fields.list.iter().filter(|field| is_option(field.key)) {
            gate.options.extend(self.option(*option, GateKind::of(&gate.kind.value)));
        }
        gate
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
            _ => {
                self.remember_broken_ends(item);
                shape::gate::is_list(item)
            }
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
        if let Some(problem) = shape::gate::keys_without_colon(&glued_keys(&fields)) {
            self.report(problem);
            return gate;
        }
        let Some(kind) = self.gate_kind(field, &fields) else { return gate };
        // Without its type, nothing is known of a gate.
        let Ok(payload) = self.payload(kind, &fields) else { return gate };
        gate.kind = spanned_key(kind);
        gate.payload = payload;
        if let Some(answer) = second_type(kind, gate.payload.as_ref(), &fields) {
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
        let known = GateKind::of(kind.key);
        let cut = cut_numbers(&fields);
        for (option, rest) in &cut {
            gate.options.extend(self.cut_number(*option, *rest, known));
        }
        let is_cut = |field: &Field<'_>| {
            cut.iter().any(|(one, rest)| [one, rest].iter().any(|of| of.key_span == field.key_span))
        };
        let rest_of_type = rest_of_type(kind, &fields);
        let is_rest = |field: &Field<'_>| is_cut(field) || is_in(rest_of_doc, field) || is_in(rest_of_type, field);
        for option in fields.list.iter().filter(|field| field.key_span != kind.key_span && !is_rest(field)) {
            let read = match is_option(option.key) {
                true => self.option(*option, known),
                false => self.misplaced(*option, known),
            };
            gate.options_unread |= read.is_none();
            if read.is_none() && !is_option(option.key) && !is_kind(option.key) {
                self.report(shape::unknown_key::of_gate(*option, kind, &path, self.source));
            }
            gate.options.extend(read);
        }
        gate
    }

    /// A key without a value that has a look-alike in it, such as another colon.
    fn look_alike_key(&self, fields: &Fields<'_>) -> Option<Diagnostic> {
        let mut empty = fields.list.iter().filter(|field| field.value.is_null() && !field.key.is_ascii());
        empty.find_map(|field| pitfall::look_alike::in_word(field.key_node, field.key, "the key", self.source))
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
        if let Some(problem) = kind.and_then(|_| shape::gate::kind_as_key(gate, fields, self.source)) {
            self.report(problem);
            return None;
        }
        kind
    }

    /// The type; none where the kind stands without a value, as in `{pub: , queue: 1}`: an untyped gate with options.
    /// An error if it is not clear which is meant.
    fn payload(&mut self, kind: Field<'_>, fields: &Fields<'_>) -> Result<Option<Spanned<String>>, Ambiguous> {
        if kind.value.is_null() {
            return Ok(None);
        }
        let span = kind.value.span;
        if let Some(written) = list_as_type(kind.value, self.source) {
            return Ok(Some(Spanned { value: written.to_owned(), span }));
        }
        if !matches!(kind.value.kind, NodeKind::Scalar { .. } | NodeKind::Unread) {
            let source = self.searches.may_search().then_some(self.source);
            let (problem, meant) = shape::gate::type_is_not_text(kind, source);
            self.report(problem);
            return meant.map(|value| Some(Spanned { value, span })).ok_or(Ambiguous);
        }
        let Some(mut payload) = self.name_in(kind, &format!("type of the `{}` gate", kind.key)) else {
            return Ok(None);
        };
        if let Some(last) = rest_of_type(kind, fields).last() {
            payload.span = payload.span.to(last.key_span);
            payload.value = self.source.snippet(payload.span).to_owned();
        }
        if matches!(kind.key, "req" | "rep")
            && let Some(odd) = odd_arrow(&payload.value)
        {
            self.report(shape::gate::odd_arrow(kind, payload.span, &odd));
            let [meant] = <[String; 1]>::try_from(odd.ways).map_err(|_| Ambiguous)?;
            payload.value = meant;
        }
        // Quotes do not change a type; the span includes them.
        Ok((kind.value.is_plain() || !payload.value.trim().is_empty()).then_some(payload))
    }
}

/// A problem says that a type may be one of several.
struct Ambiguous;

/// `{pub: [u8; 256]}`: a list that is rather a type in the words of a programming language.
fn list_as_type<'s>(value: &Node, source: &'s SourceFile) -> Option<&'s str> {
    let [only] = value.items()? else { return None };
    let written = source.snippet(value.span);
    let is_name = |text: &str| text.contains('.') || text.starts_with(char::is_uppercase);
    let is_other = only.text().is_some_and(|text| !is_name(text) && !text.contains(['/', '#', '\n']));
    (is_other && only.is_plain() && written.starts_with('[') && !written.contains('\n')).then_some(written)
}

/// Whether each entry is an item of a list whose dash lacks its space: `-measurements: pub`.
fn is_glued_dash(entries: &[(Node, Node)]) -> bool {
    let is_glued = |key: &Node| {
        key.is_plain() && scalar(key).is_some_and(|key| key.value.starts_with('-') && !key.value.starts_with("--"))
    };
    !entries.is_empty() && entries.iter().all(|(key, _)| is_glued(key))
}

fn bare_gate(name: Spanned<String>, kind: Spanned<String>, span: Span) -> GateModel {
    GateModel { name, kind, payload: None, options: Vec::new(), options_unread: false, span }
}

/// A gate of which only the name is known.
fn unread_gate(name: Spanned<String>) -> GateModel {
    let span = name.span;
    let nothing = Spanned { value: String::new(), span: Span { start: span.end, ..span } };
    bare_gate(name, nothing, span)
}
