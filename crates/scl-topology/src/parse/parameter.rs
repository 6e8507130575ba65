//! The parameters of a component, or of a kind.

mod meant;

use super::field::{Field, Fields, spanned_key};
use super::{Reader, pitfall, scalar, shape};
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::grammar::parameter::{LIST, PARAMETER_KEYS, TYPES};
use crate::model::{ParameterModel, WrittenValue};
use crate::source::{Span, Spanned};
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};
use meant::{key_of_others, type_of_value, type_of_values, types_of};
use scl_text::list::quoted_list;

/// SCL1901.
pub(crate) const NO_PARAMETER: Rule = Rule {
    code: "SCL1901",
    severity: Severity::Error,
    title: "not a parameter",
    explanation: "An entry of `parameters` is a name with a type: `gain: f64`. In braces, the value behind the type is \
                  the default, and `range`, `unit`, `doc` and `live` may follow: `gain: {f64: 0.8, range: [0, 10]}`. One of \
                  several words is `mode: {one_of: [manual, auto], default: manual}`, and a list is \
                  `offsets: {list: f64, length: 3}`. Without a default, the launch file must give a value.",
    example: " components:
   - name: controller
     parameters:
-      - gain: 0.8
+      - gain: {f64: 0.8}
     gates: []
",
};

/// How a parameter is declared, for help.
const FORM: &str = "a parameter is a name and a type: `- gain: f64`, or with a default: `- gain: {f64: 0.8}`";

/// How a list is declared, for help.
pub(crate) const LIST_FORM: &str = "write for example `{list: f64, length: 3, default: [0, 0, 0]}`";

/// How a range is written, for help.
const RANGE_FORM: &str = "write the least and the largest value: `range: [0, 10]`";

/// The words for the least and the largest value of a range.
const ENDS: [(&str, &str); 5] =
    [("min", "max"), ("least", "largest"), ("lower", "upper"), ("low", "high"), ("from", "to")];

impl Reader<'_> {
    pub(super) fn read_parameters(&mut self, field: Field<'_>) -> Vec<ParameterModel> {
        match &field.value.kind {
            NodeKind::Unread => Vec::new(),
            NodeKind::Sequence { items } => items.iter().filter_map(|item| self.read_parameter_item(item)).collect(),
            NodeKind::Mapping { entries } => {
                self.report(shape::section_kind::items(field, "parameter", self.source));
                let fields = self.fields(entries, "`parameters`");
                fields.list.into_iter().filter_map(|parameter| self.read_parameter(parameter)).collect()
            }
            _ if field.value.is_null() => Vec::new(),
            _ => {
                self.report(self.glued_or(field.value, shape::section_kind::text(field)));
                Vec::new()
            }
        }
    }

    fn read_parameter_item(&mut self, item: &Node) -> Option<ParameterModel> {
        let NodeKind::Mapping { entries } = &item.kind else {
            let problem = match &item.kind {
                NodeKind::Unread => return None,
                _ if item.is_null() => pitfall::no_value::in_list(item, "list item", self.source),
                _ => self.glued_or(item, NO_PARAMETER.at("a parameter has no type", item.span, "").help(FORM)),
            };
            self.report(problem);
            return None;
        };
        let fields = self.fields(entries, "this parameter");
        match fields.list.as_slice() {
            [] => None,
            [parameter] => self.read_parameter(*parameter),
            [first, second, ..] => {
                let problem = NO_PARAMETER.at("two keys in one parameter", second.key_span, "the second one");
                self.report(problem.label(first.key_span, "the first one").help(
                    "each parameter is an item of its own; what is said about it stands in braces behind its name: \
                     `- gain: {f64: 0.8, unit: 1/s}`",
                ));
                None
            }
        }
    }

    fn read_parameter(&mut self, field: Field<'_>) -> Option<ParameterModel> {
        let name = self.name(field.key_node, "parameter name", "a parameter name")?;
        let span = field.key_span.to(field.value.span);
        match &field.value.kind {
            NodeKind::Unread => None,
            NodeKind::Mapping { entries } => {
                let fields = self.fields(entries, "this parameter");
                self.read_parameter_fields(name, &fields, span)
            }
            NodeKind::Scalar { text, .. } if TYPES.contains(&text.as_str()) => {
                let kind = scalar(field.value)?;
                Some(ParameterModel { name, kind, value: None, keys: Vec::new(), span })
            }
            _ => {
                let problem = self.untyped(&name, field);
                self.report(problem);
                None
            }
        }
    }

    fn read_parameter_fields(
        &mut self,
        name: Spanned<String>,
        fields: &Fields<'_>,
        span: Span,
    ) -> Option<ParameterModel> {
        let mut types = fields.list.iter().filter(|field| TYPES.contains(&field.key));
        let Some(kind) = types.next() else {
            if !fields.damaged {
                let problem = without_type(&name, fields, span);
                self.report(problem);
            }
            return None;
        };
        if let Some(second) = types.next() {
            let headline = format!("parameter `{}` has two types", name.value);
            let problem = NO_PARAMETER.at(headline, second.key_span, "the second one");
            self.report(problem.label(kind.key_span, "the first one").help("remove one of them"));
            return None;
        }
        let mut keys = Vec::new();
        for field in fields.list.iter().filter(|field| field.key_span != kind.key_span) {
            if !PARAMETER_KEYS.contains(&field.key) {
                let found = NO_PARAMETER.at(format!("unknown key `{}` of a parameter", field.key), field.key_span, "");
                let meant: Vec<&str> = match key_of_others(field.key) {
                    Some(key) if fields.get(key).is_none() => vec![key],
                    _ => similar(field.key, PARAMETER_KEYS),
                };
                let found = found.did_you_mean(field.key, &meant);
                self.report(found.note(format!("keys: a type, and {}", quoted_list(PARAMETER_KEYS))));
                continue;
            }
            if let Some(value) = self.written_value(*field, field.value.is_null()) {
                keys.push((spanned_key(*field), value));
            }
        }
        let value = if kind.value.is_null() { None } else { Some(self.written_value(*kind, false)?) };
        Some(ParameterModel { name, kind: spanned_key(*kind), value, keys, span })
    }

    /// A single value, or a list of such.
    fn written_value(&mut self, field: Field<'_>, is_missing: bool) -> Option<WrittenValue> {
        let problem = match &field.value.kind {
            NodeKind::Unread => return None,
            _ if is_missing => pitfall::no_value::in_field(field, &format!("value of `{}`", field.key), self.source),
            NodeKind::Scalar { .. } => return scalar(field.value).map(WrittenValue::One),
            NodeKind::Sequence { items } => {
                let texts = items.iter().map(scalar).collect::<Option<Vec<_>>>();
                match texts {
                    Some(texts) => return Some(WrittenValue::Many(texts, field.value.span)),
                    None => NO_PARAMETER
                        .at(format!("`{}` is a list of single values", field.key), field.value.span, "")
                        .help("each item is a number, a text, a duration, or `true` or `false`"),
                }
            }
            NodeKind::Mapping { entries } => mapping(field, entries),
        };
        self.report(problem);
        None
    }

    /// The value of a parameter where its type belongs, or an unknown type.
    fn untyped(&self, name: &Spanned<String>, field: Field<'_>) -> Diagnostic {
        let value = field.value;
        if super::name::is_empty(value) {
            let found = NO_PARAMETER.at(format!("parameter `{}` has no type", name.value), field.key_span, "");
            return found.help(FORM);
        }
        let word = value.text().unwrap_or_default();
        let meant = types_of(word);
        if !meant.is_empty() && value.text().is_some() {
            let headline = format!("unknown type `{word}` of parameter `{}`", name.value);
            return NO_PARAMETER.at(headline, value.span, "").did_you_mean(word, &meant).note(types_note());
        }
        let headline = format!("parameter `{}` has a value, but no type", name.value);
        let found = NO_PARAMETER.at(headline, value.span, "a value, where a type is expected");
        let written = self.source.snippet(value.span);
        let typed = match &value.kind {
            NodeKind::Sequence { items } => {
                let item = type_of_values(items.iter().filter_map(Node::text));
                format!("{{list: {item}, default: {written}}}")
            }
            _ => format!("{{{}: {written}}}", type_of_value(word)),
        };
        match written.contains('\n') {
            true => found.help(FORM),
            false => found.propose(format!("write `{}: {typed}`", name.value), [Edit::new(value.span, typed.clone())]),
        }
    }
}

/// A mapping in the place of a value.
fn mapping(field: Field<'_>, entries: &[(Node, Node)]) -> Diagnostic {
    let (key, span) = (field.key, field.value.span);
    let headline = format!("`{key}` is a single value, or a list");
    let found = NO_PARAMETER.at(headline, span, "this is a mapping");
    let value =
        |word: &str| entries.iter().find(|(key, _)| key.text() == Some(word)).and_then(|(_, value)| value.text());
    let ends = ENDS.iter().find_map(|(least, largest)| Some((value(least)?, value(largest)?)));
    match (key, ends) {
        ("range", Some((least, largest))) if entries.len() == 2 => {
            let range = format!("[{least}, {largest}]");
            found.propose(format!("write `range: {range}`"), [Edit::new(span, range)])
        }
        ("range", _) => found.help(RANGE_FORM),
        (LIST, _) => found.help(LIST_FORM),
        _ if TYPES.contains(&key) => found.help(format!(
            "the default stands behind the type, and anything else beside it: `{{{key}: ..., doc: ...}}`"
        )),
        _ => found.help("a parameter has no parts: declare a parameter for each"),
    }
}

/// `{default: 0.8}`, `{type: f64}`, or a misspelt type.
fn without_type(name: &Spanned<String>, fields: &Fields<'_>, span: Span) -> Diagnostic {
    if let Some(field) = fields.get("type") {
        let word = field.value.text().unwrap_or("f64");
        let headline = format!("the type of parameter `{}` is a key", name.value);
        let word = types_of(word).first().copied().unwrap_or(word).to_owned();
        return NO_PARAMETER
            .at(headline, field.key_span, "")
            .help(format!("write `{{{word}: ...}}` with the default in place of the dots, or `{word}` alone"))
            .note(types_note());
    }
    let mut misspelt = fields.list.iter().filter(|field| !PARAMETER_KEYS.contains(&field.key));
    let meant = misspelt.find_map(|field| Some((field, types_of(field.key))).filter(|it| !it.1.is_empty()));
    match meant {
        Some((field, meant)) => {
            let headline = format!("unknown type `{}` of parameter `{}`", field.key, name.value);
            let edits = meant.iter().map(|meant| Edit::new(field.key_span, *meant));
            let found = NO_PARAMETER.at(headline, field.key_span, "");
            found.choose(("write ", ""), meant.iter().copied().zip(edits)).note(types_note())
        }
        None => {
            NO_PARAMETER.at(format!("parameter `{}` has no type", name.value), span, "").help(FORM).note(types_note())
        }
    }
}

fn types_note() -> String {
    format!("types: {}", quoted_list(TYPES))
}
