//! SCL0211: a connection that is not a pair of ends.

use crate::confusable;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal, separator};
use crate::kinds::{EACH, each_of};
use crate::parse::{scalar, shape_word};
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0211.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0211",
    severity: Severity::Error,
    title: "connection does not have two ends",
    explanation: "A connection is a pair: `[component.gate, component.gate]`, in either order. This entry has fewer or \
                  more ends, or is not a list. For one sender and several receivers, write one connection for each \
                  receiver.",
    example: " components: []
-connections:
-  - [controller.events, user_interface.events, logger.events]
+connections: []
",
};

const PAIR: &str = "a connection joins exactly two gates";

/// What is allowed, where nobody can know the names.
pub(super) const FORM: &str = "a connection is written `[component.gate, component.gate]`";

/// Maximum number of connections that are made of one entry.
const MOST_PAIRS: usize = 10;

/// Marks that people write between the two ends.
const ARROWS: [&str; 10] = ["<->", "-->", "->", "=>", "<-", "→", ";", "|", "&", ":"];

/// The words of a text that stands for a pair, without the marks around them and between them.
pub(in crate::parse) fn words(text: &str) -> Vec<&str> {
    const MARKS: [char; 17] = ['[', ']', '{', '}', '(', ')', '"', '\'', ',', ';', '=', '|', '&', '-', '<', '>', ':'];
    let words = text.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '|' | '→'));
    let parts = words.flat_map(|word| word.split("->").flat_map(|part| part.split("=>")));
    let parts = parts.flat_map(|part| part.split("--")).map(|word| word.trim_matches(MARKS));
    with_each(text, parts.flat_map(apart).filter(|word| !word.is_empty()))
}

/// The words, with `each motor.state` as one of them.
fn with_each<'t>(text: &'t str, words: impl Iterator<Item = &'t str>) -> Vec<&'t str> {
    let start = |word: &str| word.as_ptr() as usize - text.as_ptr() as usize;
    let mut joined: Vec<&str> = Vec::new();
    for word in words {
        let whole = |each: &str| &text[start(each)..start(word) + word.len()];
        match joined.last_mut().filter(|last| **last == EACH && each_of(whole(last)) == Some(word)) {
            Some(each) => *each = whole(each),
            None => joined.push(word),
        }
    }
    joined
}

/// The ends in `a.b:c.d`, or else the whole word.
fn apart(word: &str) -> impl Iterator<Item = &str> {
    let is_mark = |letter: char| matches!(letter, ':' | '=' | '/' | '~' | '+' | '<' | '>');
    let is_several = word.split(is_mark).filter(|part| !part.is_empty()).all(|part| part.contains('.'));
    word.split(move |letter| is_several && is_mark(letter))
}

/// A list of one, three or more.
pub(in crate::parse) fn count(span: Span, items: &[Node], source: &SourceFile) -> Diagnostic {
    if let [Node { kind: NodeKind::Scalar { text, .. }, .. }] = items
        && let [first, second] = words(text).as_slice()
    {
        return separated_oddly(span, text, first, second);
    }
    if let [Node { kind: NodeKind::Mapping { entries }, .. }] = items
        && let [(first, second)] = entries.as_slice()
        && let (Some(first), Some(second)) = (scalar(first), scalar(second))
    {
        return separated_oddly(span, ":", &first.value, &second.value);
    }
    let (lists, label) = match items.len() {
        0 => ("is empty".to_owned(), "no gates".to_owned()),
        1 => ("lists 1".to_owned(), "1 gate".to_owned()),
        count => (format!("lists {count}"), format!("{count} gates")),
    };
    let problem = RULE.at(format!("{PAIR}; this one {lists}"), span, label);
    let names: Option<Vec<String>> = items.iter().map(|item| scalar(item).map(|name| name.value)).collect();
    match names.as_deref() {
        Some([]) => with_removal(problem, span, source),
        Some([one]) => problem.help(one_end(one)),
        Some(ends) => with_pairs(with_dots(problem, span, ends, source), span, ends, source),
        None => problem.help(FORM),
    }
}

/// `[]`: nothing is lost without it.
fn with_removal(problem: Diagnostic, span: Span, source: &SourceFile) -> Diagnostic {
    match removal(source, span) {
        Some(removed) => problem.suggest("remove it", [removed]),
        None => problem.help(FORM),
    }
}

/// `[sensor, measurements, controller.sensor]`: a comma stands in the place of a dot.
fn with_dots(problem: Diagnostic, span: Span, parts: &[String], source: &SourceFile) -> Diagnostic {
    match dotted(parts) {
        Some([first, second]) => with_connections(problem, span, &[(first, second)], source),
        None => problem,
    }
}

/// The two ends that parts of names are, if there are two.
fn dotted(parts: &[String]) -> Option<[String; 2]> {
    let mut ends: Vec<String> = Vec::new();
    let mut parts = parts.iter();
    while let Some(part) = parts.next().filter(|_| ends.len() < 3) {
        let gate = if part.contains('.') { None } else { parts.next() };
        ends.push(match gate {
            Some(end) if part == EACH => format!("{part} {end}"),
            Some(gate) => format!("{part}.{gate}"),
            None => part.clone(),
        });
    }
    ends.try_into().ok()
}

/// The two ends that a malformed entry stands for, as far as it is clear: as a list of parts or as a mapping.
pub(in crate::parse) fn recovered(item: &Node) -> Option<[String; 2]> {
    let ends = match &item.kind {
        NodeKind::Sequence { items } => dotted(&items.iter().map(end).collect::<Option<Vec<_>>>()?),
        NodeKind::Mapping { entries } => {
            let ends: Vec<String> =
                entries.iter().filter_map(|(_, value)| end(value)).filter(|end| end.contains('.')).collect();
            <[String; 2]>::try_from(ends).ok()
        }
        NodeKind::Scalar { text, .. } => match words(&confusable::retyped(text)).as_slice() {
            [first, second] => Some([with_dot(first), with_dot(second)]),
            _ => None,
        },
        NodeKind::Unread => None,
    };
    ends.filter(|ends| ends.iter().all(|end| end.contains('.')))
}

/// The connections that a list of ends may mean: of its first end with all others, or of its last.
fn with_pairs(problem: Diagnostic, span: Span, ends: &[String], source: &SourceFile) -> Diagnostic {
    if let [one, other] = ends {
        return with_pair(problem, span, [one, other]);
    }
    let (Some((first, behind)), Some((last, before))) = (ends.split_first(), ends.split_last()) else { return problem };
    let of_first: Vec<(&str, &str)> = behind.iter().map(|other| (first.as_str(), other.as_str())).collect();
    let of_last: Vec<(&str, &str)> = before.iter().map(|other| (other.as_str(), last.as_str())).collect();
    let by_two: Vec<(&str, &str)> = match ends.len() % 2 {
        0 => ends.chunks(2).map(|pair| (pair[0].as_str(), pair[1].as_str())).collect(),
        _ => Vec::new(),
    };
    let ways = [of_first, of_last, by_two].into_iter().filter(|pairs| (1..=MOST_PAIRS).contains(&pairs.len()));
    ways.fold(problem, |problem, pairs| with_connections(problem, span, &pairs, source)).otherwise(FORM)
}

/// Adds the proposal to write these connections in the place of an entry.
fn with_connections<E: AsRef<str>>(
    problem: Diagnostic,
    span: Span,
    pairs: &[(E, E)],
    source: &SourceFile,
) -> Diagnostic {
    let Some(separator) = separator(source, span).filter(|_| !source.snippet(span).contains('#')) else {
        return problem;
    };
    let pairs: Vec<String> =
        pairs.iter().map(|(one, other)| format!("[{}, {}]", one.as_ref(), other.as_ref())).collect();
    let text = match pairs.as_slice() {
        [only] => format!("write `{only}`"),
        pairs => format!("write one connection for each pair:\n- {}", pairs.join("\n- ")),
    };
    problem.suggest(text, [Edit::new(span, pairs.join(&separator))])
}

/// `[sensor.measurements controller.sensor]`: two ends with no comma, or with something else, between them.
fn separated_oddly(span: Span, text: &str, first: &str, second: &str) -> Diagnostic {
    let between = ARROWS.into_iter().find(|mark| text.contains(mark));
    let (message, label) = match between {
        Some(mark) => {
            (format!("`{mark}` does not separate the ends of a connection"), "expected a comma between the two")
        }
        None => ("a comma is missing between the ends of this connection".to_owned(), "one text, not two ends"),
    };
    let pair = pair([first, second]);
    RULE.at(message, span, label).propose(format!("write `{pair}`"), [Edit::new(span, pair)])
}

/// `- sensor.measurements`, `- a.b -> c.d`, `- (a.b, c.d)`.
pub(in crate::parse) fn text(item: &Node, text: &str, source: &SourceFile) -> Diagnostic {
    let ends = words(text);
    let arrow = text.split_whitespace().find(|word| matches!(*word, "->" | "<-" | "<->" | "=>" | "-->" | "→"));
    let label = match (arrow, ends.len()) {
        (Some(arrow), 0 | 1) => format!("one end of `{arrow}` is missing"),
        _ => "this is text".to_owned(),
    };
    let problem = RULE.at(format!("{PAIR}; this one is text"), item.span, label);
    // `connect a.b to c.d`: the words without a dot are not ends.
    let dotted: Vec<&str> = ends.iter().copied().filter(|end| end.contains('.')).collect();
    match (ends.as_slice(), dotted.as_slice()) {
        ([one], _) => problem.help(one_end(one)),
        ([first, second], _) | (_, [first, second]) => with_pair(problem, item.span, [first, second]),
        (_, [_, _, ..]) => {
            let ends: Vec<String> = dotted.iter().map(|end| (*end).to_owned()).collect();
            with_pairs(problem, item.span, &ends, source)
        }
        _ => problem.help(FORM),
    }
}

/// `- sensor.measurements: controller.sensor`, `- {sensor.measurements, controller.sensor}`, `- {from: a.b, to: c.d}`.
pub(in crate::parse) fn mapping(item: &Node, source: &SourceFile) -> Diagnostic {
    let problem = RULE.at(format!("{PAIR}; this one is a mapping"), item.span, "a key and its value");
    let NodeKind::Mapping { entries } = &item.kind else { return problem };
    if source.snippet(item.span).contains('#') {
        return problem.help(FORM);
    }
    match entries.as_slice() {
        [(first, second)] => match (scalar(first), &second.kind) {
            (Some(first), NodeKind::Sequence { items }) => {
                let ends: Option<Vec<String>> =
                    std::iter::once(Some(first.value)).chain(items.iter().map(end)).collect();
                match ends {
                    Some(ends) => with_pairs(problem, item.span, &ends, source),
                    None => problem.help(FORM),
                }
            }
            (Some(first), _) if second.is_null() => problem.help(one_end(&first.value)),
            (Some(first), _) => match scalar(second) {
                Some(second) => with_pair(problem, item.span, [&first.value, &second.value]),
                None => problem.help(FORM),
            },
            _ => problem.help(FORM),
        },
        [(first, nothing), (second, nothing_more)]
            if nothing.is_null()
                && nothing_more.is_null()
                && let (Some(first), Some(second)) = (scalar(first), scalar(second)) =>
        {
            let problem = RULE.at("a pair stands in brackets, not in braces", item.span, "braces");
            with_pair(problem, item.span, [&first.value, &second.value])
        }
        _ => {
            let ends: Vec<String> =
                entries.iter().filter_map(|(_, value)| end(value)).filter(|end| end.contains('.')).collect();
            match ends.as_slice() {
                [first, second] => with_pair(problem, item.span, [first, second]),
                _ => problem.help(FORM),
            }
        }
    }
}

/// `connections: {a.b: c.d}`: each entry as an item of a list, and how to do that. None if an entry has another form.
pub(in crate::parse) fn of_section(value: &Node, source: &SourceFile) -> Option<(&'static str, Vec<Edit>)> {
    let NodeKind::Mapping { entries } = &value.kind else { return None };
    let is_flow = source.snippet(value.span).starts_with('{');
    let is_pair = |node: &Node| matches!(node.kind, NodeKind::Sequence { .. });
    let is_group = |(_, pairs): &(Node, Node)| pairs.items().is_some_and(|items| items.iter().all(is_pair));
    if !is_flow && entries.iter().all(is_group) {
        // The names of groups of connections become comments.
        let mark = |(key, _): &(Node, Node)| Edit::new(Span { end: key.span.start, ..key.span }, "# ");
        return Some(("make comments of the names of the groups", entries.iter().map(mark).collect()));
    }
    let mut edits = Vec::new();
    for (from, to) in entries {
        let from_end = scalar(from)?.value;
        let others: Vec<String> = match &to.kind {
            NodeKind::Sequence { items } => items.iter().map(end).collect::<Option<_>>()?,
            _ => vec![end(to)?],
        };
        let entry = from.span.to(to.span);
        let indent = " ".repeat(source.column(from.span.start));
        let (start, separator) = if is_flow { ("", ", ".to_owned()) } else { ("- ", format!("\n{indent}- ")) };
        let pairs: Vec<String> = others.iter().map(|other| pair([&from_end, other])).collect();
        if source.snippet(entry).contains('#') || pairs.is_empty() {
            return None;
        }
        edits.push(Edit::new(entry, format!("{start}{}", pairs.join(&separator))));
    }
    if is_flow {
        let Span { start, end, .. } = value.span;
        edits.push(Edit::new(Span { end: start + 1, ..value.span }, "["));
        edits.push(Edit::new(Span { start: end - 1, ..value.span }, "]"));
    }
    Some(("write each connection as a pair in brackets", edits))
}

/// A list or mapping as one of two ends.
pub(in crate::parse) fn end_is_not_text(node: &Node) -> Diagnostic {
    let message = format!("an end of a connection is `component.gate`; this is {}", shape_word(node));
    let problem = RULE.at(message, node.span, format!("this is {}", shape_word(node)));
    match end(node) {
        Some(end) => problem.propose(format!("write `{end}`"), [Edit::new(node.span, end)]),
        None => problem,
    }
}

/// `[a.b, [c.d, e.f]]`, where one end is a list of gates, and the problem with the connections that are meant.
pub(in crate::parse) fn branched(span: Span, ends: [&Node; 2], source: &SourceFile) -> Option<Diagnostic> {
    let gates = |node: &Node| -> Option<Vec<String>> {
        let NodeKind::Sequence { items } = &node.kind else { return scalar(node).map(|end| vec![end.value]) };
        let names: Vec<String> = items.iter().map(|item| scalar(item).map(|name| name.value)).collect::<Option<_>>()?;
        names.iter().all(|name| name.contains('.')).then_some(names)
    };
    let [first, second] = [gates(ends[0])?, gates(ends[1])?];
    let list = ends.into_iter().find(|end| matches!(end.kind, NodeKind::Sequence { .. }))?;
    let pairs: Vec<(&String, &String)> =
        first.iter().flat_map(|one| second.iter().map(move |other| (one, other))).take(MOST_PAIRS + 1).collect();
    let problem = RULE.at("an end of a connection is one gate; this is a list", list.span, "");
    Some(match (1..=MOST_PAIRS).contains(&pairs.len()) {
        true => with_connections(problem, span, &pairs, source),
        false => problem.help(FORM),
    })
}

/// The end that a value stands for: `a.b`, `{a: b}`, `{component: a, gate: b}` or `[a, b]`.
fn end(node: &Node) -> Option<String> {
    let [component, gate] = match &node.kind {
        NodeKind::Scalar { .. } => return scalar(node).map(|end| end.value),
        NodeKind::Mapping { entries } => match entries.as_slice() {
            [(component, gate)] | [(_, component), (_, gate)] => [component, gate],
            _ => return None,
        },
        NodeKind::Sequence { items } => match items.as_slice() {
            [component, gate] => [component, gate],
            _ => return None,
        },
        NodeKind::Unread => return None,
    };
    Some(format!("{}.{}", scalar(component)?.value, scalar(gate)?.value))
}

fn one_end(end: &str) -> String {
    format!("the gate at the other end is missing: a connection is written `[{end}, component.gate]`")
}

fn pair(ends: [&str; 2]) -> String {
    format!("[{}, {}]", with_dot(ends[0]), with_dot(ends[1]))
}

/// An end with a dot, where a slash or a colon stands in its place.
pub(super) fn with_dot(end: &str) -> String {
    match end.contains('.') {
        true => end.to_owned(),
        false => end.replacen("::", ".", 1).replacen(['/', ':'], ".", 1),
    }
}

fn with_pair(problem: Diagnostic, span: Span, ends: [&str; 2]) -> Diagnostic {
    let pair = pair(ends);
    problem.propose(format!("write `{pair}`"), [Edit::new(span, pair)]).otherwise(FORM)
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
                error: [SCL0211] a connection joins exactly two gates; this one lists 3
                 --> topology.yaml:3:5
                  |
                3 |   - [controller.events, user_interface.events, logger.events]
                  |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ 3 gates
                  |
                  = help: write one connection for each pair:
                          - [controller.events, user_interface.events]
                          - [controller.events, logger.events]
                  = help: write one connection for each pair:
                          - [controller.events, logger.events]
                          - [user_interface.events, logger.events]"#]],
        );
    }
}
