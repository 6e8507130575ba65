//! SCL0210: a gate that is not written as `name: kind` or `name: {kind: type, option: value}`.

use super::option_value::{self, replacement};
use super::reference::{is_type, types_meant};
use super::shift;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::habits;
use crate::model::GateModel;
use crate::parse::exchange::Odd;
use crate::parse::field::{Field, Fields};
use crate::parse::scalar;
use crate::parse::words::{is_kind, is_option};
use crate::source::{SourceFile, Span};
use crate::suggest;
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
    RULE.at(format!("gate `{name}` has no kind"), at, "expected a kind after the name")
        .help(format!("a gate is written `{name}: kind`, or `{name}: {{kind: type}}`"))
        .note(kinds())
}

/// `- measurements pub`, `- measurements {pub: Fix}`.
pub(in crate::parse) fn without_colon(name: &str, kind: &str, at: Span) -> Diagnostic {
    let end = at.start + name.len() as u32;
    RULE.at(format!("missing `:` after the name of gate `{name}`"), at, "name and kind in one word")
        .propose(format!("write `- {name}: {kind}`"), [Edit::new(Span { start: end, end, ..at }, ":")])
}

/// `- measurements = pub`.
pub(in crate::parse) fn equals_sign(name: &str, kind: &str, at: Span) -> Diagnostic {
    RULE.at(format!("`=` stands where the `:` of gate `{name}` is expected"), at, "YAML reads this as one word")
        .propose(format!("write `- {name}: {kind}`"), [Edit::new(at, format!("{name}: {kind}"))])
}

/// What stands between a key and its value in other languages: `=`, `:=`, `=>`.
const MARKS: [char; 3] = ['=', ':', '>'];

/// `{pub Type}`, `{pub: Type, queue=4}`: keys with the word at their start, and the key that is meant by it.
pub(in crate::parse) fn keys_without_colon(glued: &[(Field<'_>, &str, &str)]) -> Option<Diagnostic> {
    let (first, word, _) = glued.first()?;
    let rest = first.key[word.len()..].trim_start();
    let mark = &rest[..rest.find(|letter: char| !MARKS.contains(&letter)).unwrap_or(rest.len())];
    let message = match mark.contains('=') {
        true => format!("`{mark}` stands where the `:` after `{word}` is expected"),
        false => format!("missing `:` after `{word}`"),
    };
    let is_before_value = |letter: char| letter == ' ' || MARKS.contains(&letter);
    let entries = glued.iter().map(|(field, word, key)| {
        let value = field.key[word.len()..].trim_start_matches(is_before_value).trim_end_matches([' ', '=', ':']);
        (field.key_span, format!("{key}: {value}"))
    });
    let entries: Vec<(Span, String)> = entries.collect();
    let text: Vec<&str> = entries.iter().map(|(_, entry)| entry.as_str()).collect();
    let text = format!("write `{}`", text.join(", "));
    let problem = RULE.at(message, first.key_span, "YAML reads this as one word");
    Some(problem.propose(text, entries.into_iter().map(|(span, entry)| Edit::new(span, entry))))
}

/// `{rep: Request, Reply}`.
pub(in crate::parse) fn comma_between_types(gate: &GateModel, answer: Field<'_>) -> Diagnostic {
    let (name, kind) = (&gate.name.value, &gate.kind.value);
    let types = gate.payload.as_ref().map_or("", |payload| &payload.value);
    let start = gate.payload.as_ref().map_or(answer.key_span.start, |payload| payload.span.end);
    let comma = Span { start, end: answer.key_span.start, ..answer.key_span };
    RULE.at(format!("the two types of gate `{name}` are joined by `->`"), answer.key_span, "read as a key, not a type")
        .propose(format!("write `{name}: {{{kind}: {types}}}`"), [Edit::new(comma, " -> ")])
}

/// `{rep: Request => Reply}`.
pub(in crate::parse) fn odd_arrow(kind: Field<'_>, types: Span, odd: &Odd) -> Diagnostic {
    let message = match odd.mark.as_str() {
        "" => "`->` is missing between the two types".to_owned(),
        "->" => "the types of a request and of its reply stand without parentheses".to_owned(),
        arrow => format!("`{arrow}` does not join two types"),
    };
    let ways: Vec<String> = odd.ways.iter().map(|meant| format!("{}: {meant}", kind.key)).collect();
    let edits = odd.ways.iter().map(|meant| Edit::new(types, meant));
    if odd.is_stream {
        let problem = RULE.at("a request has one reply, not a stream of them", types, "");
        let single = ways
            .iter()
            .zip(edits)
            .fold(problem, |problem, (way, edit)| problem.suggest(format!("write `{way}`, if one is enough"), [edit]));
        return single
            .help("for several at once, name a message with a `repeated` field of them")
            .help("for one after the other, use a `pub` gate or a `push` gate beside the request");
    }
    RULE.at(message, types, "expected the request, `->` and the reply")
        .choose(("write ", ""), ways.iter().map(String::as_str).zip(edits))
}

/// `{rep: {request: A, response: B}}`, `{pub: [A, B]}`: what the type is, and what it certainly is meant to be. The
/// `source` is searched for types that a reference may mean.
pub(in crate::parse) fn type_is_not_text(kind: Field<'_>, source: Option<&SourceFile>) -> (Diagnostic, Option<String>) {
    let key = kind.key;
    let problem = option_value::not_text(&format!("`{key}`"), kind.value);
    let is_list = matches!(kind.value.kind, NodeKind::Sequence { .. });
    let values: Vec<&Node> = match &kind.value.kind {
        NodeKind::Sequence { items } => items.iter().collect(),
        NodeKind::Mapping { entries } => entries.iter().map(|(_, value)| value).collect(),
        _ => Vec::new(),
    };
    let types: Option<Vec<&str>> = values.into_iter().map(Node::text).collect();
    let with_type =
        |problem: Diagnostic, name: &str| problem.suggest(format!("write `{key}: {name}`"), [replacement(kind, name)]);
    match (types.as_deref(), key) {
        (Some([request, reply]), "req" | "rep") if is_type(request) && is_type(reply) => {
            let meant = format!("{request} -> {reply}");
            (problem.propose(format!("write `{key}: {meant}`"), [replacement(kind, &meant)]), Some(meant))
        }
        (_, "req" | "rep") => (problem.help("the types of a request and of its reply are joined by `->`"), None),
        (Some([only]), _) if is_type(only) && !is_list => {
            let meant = (*only).to_owned();
            (problem.propose(format!("write `{key}: {meant}`"), [replacement(kind, &meant)]), Some(meant))
        }
        (Some([only]), _) => {
            let problem = types_meant(only, source).iter().fold(problem, |problem, name| with_type(problem, name));
            let text = match is_list {
                true => "a gate carries one message; a list is a `repeated` field of it".to_owned(),
                false => format!("a type is a dotted name: `{key}: package.Message`"),
            };
            (problem.otherwise(text), None)
        }
        _ => (problem.help("a gate carries one type; each further type needs a gate of its own"), None),
    }
}

/// `- measurements: {queue: 4}`.
pub(in crate::parse) fn without_kind_key(gate: Field<'_>, fields: &Fields<'_>) -> Diagnostic {
    let name = gate.key;
    let label = if fields.list.is_empty() { "empty" } else { "only options here" };
    RULE.at(format!("gate `{name}` has no kind"), gate.value.span, label)
        .help(format!("the kind comes first, with the type as its value: `{name}: {{kind: type, option: value}}`"))
        .note(kinds())
}

/// `- measurements: {pub: A, sub: B}`.
pub(in crate::parse) fn two_kinds(name: &str, first: &Field<'_>, second: &Field<'_>) -> Diagnostic {
    let message = format!("gate `{name}` has two kinds, `{}` and `{}`", first.key, second.key);
    RULE.at(message, second.key_span, "second kind")
        .label(first.key_span, "first kind")
        .help(format!("a gate has one kind; `{}` needs a gate of its own, with a name of its own", second.key))
}

/// `- measurements: [pub]`, `- measurements: [pub, Type]`.
pub(in crate::parse) fn kind_is_list(gate: Field<'_>) -> Diagnostic {
    let name = gate.key;
    let message = format!("the kind of gate `{name}` must be one word; this is a list");
    let problem = RULE.at(message, gate.value.span, "expected a kind");
    let words: Vec<String> =
        gate.value.items().unwrap_or_default().iter().filter_map(scalar).map(|word| word.value).collect();
    let value = match words.as_slice() {
        [kind] if is_kind(kind) => kind.clone(),
        [kind, payload] if is_kind(kind) && !is_kind(payload) => format!("{{{kind}: {payload}}}"),
        _ => {
            return problem
                .help(format!("a gate is written `{name}: kind`, or `{name}: {{kind: type}}`"))
                .note(kinds());
        }
    };
    problem.propose(format!("write `- {name}: {value}`"), [replacement(gate, &value)]).note(kinds())
}

/// `- measurements: pub Type`, `- measurements: Publisher<Type>`: kind and type without braces.
pub(in crate::parse) fn kind_and_type(gate: Field<'_>, value: &str) -> Option<Diagnostic> {
    let name = gate.key;
    if let Some(written) = element(value) {
        let message = format!("gate `{name}` is written as an element of XML");
        let problem = RULE.at(message, gate.value.span, "read as one word");
        return Some(problem.propose(format!("write `{name}: {written}`"), [replacement(gate, &written)]));
    }
    let (kind, rest) = value.split_at(value.find(|letter: char| !letter.is_alphanumeric() && letter != '_')?);
    let kind = known_kind(kind)?;
    let payload = rest.trim_matches([' ', '\t', '(', ')', '<', '>', '[', ']', ',', ':', '/']);
    if payload.is_empty() {
        return None;
    }
    let written = format!("{{{kind}: {payload}}}");
    let message = format!("gate `{name}` has its type outside of braces");
    let problem = RULE.at(message, gate.value.span, "kind and type in one word");
    let problem = problem.propose(format!("write `{name}: {written}`"), [replacement(gate, &written)]);
    Some(problem.otherwise(format!("the type stands in braces, after its kind: `{name}: {{{kind}: type}}`")))
}

/// The kind that a word is, also in the words of other tools.
pub(super) fn known_kind(word: &str) -> Option<&'static str> {
    match suggest::kind(word).as_slice() {
        [kind] => Some(kind),
        _ => GateKind::of(word).map(GateKind::word),
    }
}

/// `<pub type="Fix" doc="One."/>` as `{pub: Fix, doc: "One."}`.
fn element(text: &str) -> Option<String> {
    let inner = text.strip_prefix('<')?.trim_end_matches(['>', '/', ' ']);
    let (kind, mut rest) = inner.split_once(' ').unwrap_or((inner, ""));
    let kind = known_kind(kind)?;
    let (mut payload, mut options) = ("", String::new());
    while let Some((key, behind)) = rest.split_once("=\"") {
        let (value, behind) = behind.split_once('"')?;
        match key.trim() {
            key if is_option(key) && value.contains([' ', ',', ':']) => {
                options.push_str(&format!(", {key}: \"{value}\""))
            }
            key if is_option(key) => options.push_str(&format!(", {key}: {value}")),
            _ => payload = value,
        }
        rest = behind;
    }
    Some(format!("{{{kind}: {payload}{options}}}"))
}

/// `- measurements: {kind: pub, type: Type}`.
pub(in crate::parse) fn kind_as_key(gate: Field<'_>, fields: &Fields<'_>, source: &SourceFile) -> Option<Diagnostic> {
    if fields.list.iter().any(|field| is_kind(field.key)) {
        return None;
    }
    let (field, kind) = fields.list.iter().find_map(|field| {
        let is_for_kind = habits::GATE.find(field.key).is_some_and(|habit| habit.is_kind());
        Some((field, known_kind(field.value.text().filter(|_| is_for_kind)?)?))
    })?;
    let of_type = fields.list.iter().find(|field| {
        habits::GATE.find(field.key).is_some_and(|habit| habit.is_type()) && field.value.text().is_some()
    });
    let message = format!("the kind of gate `{}` is written as a value", gate.key);
    let problem = RULE.at(message, field.key_span, "the kind itself is the key");
    let payload = of_type.and_then(|field| field.value.text()).unwrap_or("");
    let written = format!("{kind}: {payload}");
    let mut edits = vec![Edit::new(field.key_span.to(field.value.span), written.clone())];
    if let Some(of_type) = of_type {
        match removal(source, of_type.key_span.to(of_type.value.span)) {
            Some(removed) => edits.push(removed),
            None => return Some(problem.help("the type is the value of the kind")),
        }
    }
    Some(problem.propose(format!("write `{}: {{{}}}`", gate.key, written.trim_end()), edits))
}

/// Two names in one list item; there is at least one other.
pub(in crate::parse) fn several_in_one_item(
    first: Field<'_>,
    others: &[&Field<'_>],
    source: &SourceFile,
) -> Diagnostic {
    let names = quoted_list(std::iter::once(first.key).chain(others.iter().map(|other| other.key)));
    let count = if others.len() == 1 { "two".to_owned() } else { (others.len() + 1).to_string() };
    let second = others.first().map_or(first, |second| **second);
    let problem = RULE
        .at(format!("{count} gates in one list item ({names})"), second.key_span, "the second gate")
        .label(first.key_span, "the first gate");
    let dash = |other: &&Field<'_>| {
        let before = Span { start: other.key_span.start.checked_sub(2)?, end: other.key_span.start, ..other.key_span };
        let is_line = shift::head(other.key_span.start, source).chars().all(|letter| letter == ' ');
        (is_line && source.snippet(before) == "  ").then(|| Edit::new(before, "- "))
    };
    match others.iter().map(dash).collect::<Option<Vec<Edit>>>() {
        Some(edits) => problem.suggest(format!("start the second with `-`: `- {}: ...`", second.key), edits),
        None => problem.help("each gate is an item of its own in the list"),
    }
}

/// `- {}`.
pub(in crate::parse) fn empty_mapping(item: &Node) -> Diagnostic {
    RULE.at("this gate has no name", item.span, "expected `name: kind`").note(kinds())
}

/// `- [measurements, pub]`.
pub(in crate::parse) fn is_list(item: &Node) -> Diagnostic {
    let problem = RULE.at("a gate is written as `name: kind`; this is a list", item.span, "a list").note(kinds());
    let words: Vec<String> =
        item.items().unwrap_or_default().iter().filter_map(scalar).map(|word| word.value).collect();
    let gate = match words.as_slice() {
        [name, kind] => format!("{name}: {kind}"),
        [name, kind, payload] => format!("{name}: {{{kind}: {payload}}}"),
        _ => return problem,
    };
    if words.iter().all(|word| word.contains('.')) {
        return RULE
            .at("a connection stands in a list of gates", item.span, "not a gate")
            .help("connections stand in the section `connections`");
    }
    problem.suggest(format!("write `- {gate}`"), [Edit::new(item.span, gate)])
}

pub(super) fn kinds() -> String {
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
                  |         ^^^^^^^^^^^^ expected a kind after the name
                  |
                  = help: a gate is written `measurements: kind`, or `measurements: {kind: type}`
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
