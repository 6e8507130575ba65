//! SCL0210: a gate that is not written as `name: kind` or `name: {kind: type, option: value}`.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::model::GateModel;
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::is_kind;
use crate::source::{Span, Spanned};
use crate::topology::GateKind;
use crate::yaml::{Node, NodeKind};
use scl_text::list::quoted_list;

/// SCL0210.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0210",
    severity: Severity::Error,
    title: "gate entry has the wrong shape",
    explanation: "An entry of `gates` is `name: kind`, or `name: {kind: type, option: value}`. This one has another \
                  shape: no kind, two kinds, two names, or the kind as a value. The message says which, and what to \
                  write.",
    example: " components:
   - name: sensor
     gates:
-      - measurements
+      - measurements: pub
       - status: pub
-        health: pub
+      - health: pub
",
};

/// `- measurements`.
pub(in crate::parse) fn without_kind(name: &str, at: Span) -> Diagnostic {
    RULE.at(format!("gate `{name}` has no kind"), at, format!("expected `{name}: pub`"))
        .help(format!("write the kind after the name: `- {name}: pub`"))
        .note(kinds())
}

/// `- measurements pub`.
pub(in crate::parse) fn without_colon(name: &str, kind: &str, at: Span) -> Diagnostic {
    RULE.at(format!("missing `:` after the name of gate `{name}`"), at, "name and kind in one word")
        .help(format!("write `- {name}: {kind}`"))
}

/// `- measurements = pub`.
pub(in crate::parse) fn equals_sign(name: &str, kind: &str, at: Span) -> Diagnostic {
    RULE.at(format!("`=` stands where the `:` of gate `{name}` is expected"), at, "YAML reads this as one word")
        .propose(format!("write `- {name}: {kind}`"), [Edit::new(at, format!("{name}: {kind}"))])
}

/// `{pub Type}`, `{pub: Type, queue=4}`.
pub(in crate::parse) fn key_without_colon(field: Field<'_>, word: &str) -> Diagnostic {
    let value = field.key[word.len()..].trim_matches([' ', '=', ':']);
    let message = match field.key.contains('=') {
        true => format!("`=` stands where the `:` after `{word}` is expected"),
        false => format!("missing `:` after `{word}`"),
    };
    RULE.at(message, field.key_span, "YAML reads this as one word")
        .propose(format!("write `{word}: {value}`"), [Edit::new(field.key_span, format!("{word}: {value}"))])
}

/// `{rep: Request, Reply}`.
pub(in crate::parse) fn comma_between_types(gate: &GateModel, answer: Field<'_>) -> Diagnostic {
    let (name, kind) = (&gate.name.value, &gate.kind.value);
    let types = gate.payload.as_ref().map_or("", |payload| &payload.value);
    RULE.at(format!("the two types of gate `{name}` are joined by `->`"), answer.key_span, "read as a key, not a type")
        .help(format!("write `{name}: {{{kind}: {types}}}`"))
}

/// `{rep: Request => Reply}`.
pub(in crate::parse) fn odd_arrow(kind: Field<'_>, arrow: &str, meant: &str) -> Diagnostic {
    let message = match arrow {
        "" => "`->` is missing between the two types".to_owned(),
        _ => format!("`{arrow}` does not join two types"),
    };
    RULE.at(message, kind.value.span, "expected `->` between the two")
        .propose(format!("write `{}: {meant}`", kind.key), [Edit::new(kind.value.span, meant)])
}

/// `- measurements: {queue: 4}`.
pub(in crate::parse) fn without_kind_key(gate: Field<'_>, fields: &Fields<'_>) -> Diagnostic {
    let name = gate.key;
    let label = if fields.list.is_empty() { "empty" } else { "only options here" };
    RULE.at(format!("gate `{name}` has no kind"), gate.value.span, label)
        .help(format!("start with kind and type: `{name}: {{pub: Type}}`"))
        .note(kinds())
}

/// `- measurements: {pub: A, sub: B}`.
pub(in crate::parse) fn two_kinds(name: &str, first: &Field<'_>, second: &Field<'_>) -> Diagnostic {
    let message = format!("gate `{name}` has two kinds, `{}` and `{}`", first.key, second.key);
    RULE.at(message, second.key_span, "second kind")
        .label(first.key_span, "first kind")
        .help("a gate has one kind; make two gates of it")
}

/// `- measurements: [pub]`.
pub(in crate::parse) fn kind_is_list(gate: Field<'_>) -> Diagnostic {
    let message = format!("the kind of gate `{}` must be one word; this is a list", gate.key);
    RULE.at(message, gate.value.span, format!("expected `{}: pub`", gate.key))
        .help(format!("write `- {}: pub`, or `- {}: {{pub: Type}}`", gate.key, gate.key))
        .note(kinds())
}

/// `- measurements: pub Type`: kind and type without braces.
pub(in crate::parse) fn kind_and_type(gate: Field<'_>, value: &str) -> Option<Diagnostic> {
    let (kind, payload) = value.split_once(char::is_whitespace).filter(|(kind, _)| is_kind(kind))?;
    let message = format!("gate `{}` has its type outside of braces", gate.key);
    let problem = RULE.at(message, gate.value.span, "kind and type in one word");
    Some(problem.help(format!("write `{}: {{{kind}: {}}}`", gate.key, payload.trim().trim_end_matches("[]"))))
}

/// `- measurements: {kind: pub, type: Type}`.
pub(in crate::parse) fn kind_as_key(gate: Field<'_>, fields: &Fields<'_>) -> Option<Diagnostic> {
    let field = fields.get("kind").filter(|_| fields.list.iter().all(|field| !is_kind(field.key)))?;
    let kind = scalar(field.value).filter(|kind| is_kind(&kind.value))?.value;
    let payload = fields.get("type").and_then(|field| scalar(field.value));
    let message = format!("the kind of gate `{}` is written as a value", gate.key);
    let help = match payload {
        Some(payload) => format!("write `{}: {{{kind}: {}}}`", gate.key, payload.value),
        None => format!("write `{}: {kind}`", gate.key),
    };
    Some(RULE.at(message, field.key_span, "the kind itself is the key").help(help))
}

/// Name and kind of `{name: measurements, kind: pub}`; none if the item is written otherwise.
pub(in crate::parse) fn long_form(fields: &Fields<'_>) -> Option<[Option<Spanned<String>>; 2]> {
    let name = fields.get("name")?;
    let kind = fields.get("kind").or_else(|| fields.get("type"))?;
    Some([scalar(name.value), scalar(kind.value)])
}

/// `- name: measurements` with `kind: pub` beside it.
pub(in crate::parse) fn written_long(item: &Node, fields: &Fields<'_>) -> Diagnostic {
    let value = |key: &str| fields.get(key).and_then(|field| scalar(field.value)).map(|value| value.value);
    let name = value("name").unwrap_or_else(|| "measurements".to_owned());
    let kind = value("kind").or_else(|| value("type")).unwrap_or_else(|| "pub".to_owned());
    let at = fields.list.first().map_or(item.span, |field| field.key_span);
    RULE.at("a gate is written as `name: kind`", at, "the name itself is the key")
        .help(format!("write `- {name}: {kind}`"))
        .note(kinds())
}

/// Two names in one list item; there is at least one other.
pub(in crate::parse) fn several_in_one_item(first: Field<'_>, others: &[&Field<'_>]) -> Diagnostic {
    let names = quoted_list(std::iter::once(first.key).chain(others.iter().map(|other| other.key)));
    let count = if others.len() == 1 { "two".to_owned() } else { (others.len() + 1).to_string() };
    let second = others.first().map_or(first, |second| **second);
    RULE.at(format!("{count} gates in one list item ({names})"), second.key_span, "the second gate")
        .label(first.key_span, "the first gate")
        .help(format!("start the second with `-`: `- {}: ...`", second.key))
}

/// `- {}`.
pub(in crate::parse) fn empty_mapping(item: &Node) -> Diagnostic {
    RULE.at("this gate has no name", item.span, "expected `measurements: pub`").note(kinds())
}

/// `- [measurements, pub]`.
pub(in crate::parse) fn is_list(item: &Node) -> Diagnostic {
    let problem = RULE.at("a gate is written as `name: kind`; this is a list", item.span, "a list");
    let NodeKind::Sequence { items } = &item.kind else { return problem.note(kinds()) };
    let [name, kind] = items.as_slice() else { return problem.help("write `- measurements: pub`").note(kinds()) };
    match (scalar(name), scalar(kind)) {
        (Some(name), Some(kind)) => problem.help(format!("write `- {}: {}`", name.value, kind.value)),
        _ => problem.note(kinds()),
    }
}

fn kinds() -> String {
    format!("kinds: {}", quoted_list(GateKind::ALL.map(GateKind::word)))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn example() {
        check(
            &RULE,
            expect![[r#"
                error: [SCL0210] gate `measurements` has no kind
                 --> topology.yaml:4:9
                  |
                4 |       - measurements
                  |         ^^^^^^^^^^^^ expected `measurements: pub`
                  |
                  = help: write the kind after the name: `- measurements: pub`
                  = note: kinds: `pub`, `sub`, `req`, `rep`, `push`, `pull`

                error: [SCL0210] two gates in one list item (`status`, `health`)
                 --> topology.yaml:6:9
                  |
                5 |       - status: pub
                  |         ------ the first gate
                6 |         health: pub
                  |         ^^^^^^ the second gate
                  |
                  = help: start the second with `-`: `- health: ...`"#]],
        );
    }
}
