//! SCL0211: a connection that is not a pair of ends.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::{scalar, shape_word};
use crate::source::Span;
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
const WRITE_A_PAIR: &str = "write `[component.gate, component.gate]`";

/// Maximum number of pairs that a help shows.
const SHOWN: usize = 10;

/// The words of a text that stands for a pair, without the marks around them and between them.
pub(in crate::parse) fn words(text: &str) -> Vec<&str> {
    const MARKS: [char; 17] = ['[', ']', '{', '}', '(', ')', '"', '\'', ',', ';', '=', '|', '&', '-', '<', '>', ':'];
    let words = text.split(|c: char| c.is_whitespace() || matches!(c, ',' | ';' | '|'));
    let parts = words.flat_map(|word| word.split("->").flat_map(|part| part.split("=>")));
    parts.map(|word| word.trim_matches(MARKS)).filter(|word| !word.is_empty()).collect()
}

/// A list of one, three or more.
pub(in crate::parse) fn count(span: Span, items: &[Node]) -> Diagnostic {
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
        Some([one]) => problem.help(one_end(one)),
        Some([first, others @ ..]) => problem.help(pairs(first, others)),
        _ => problem.help(WRITE_A_PAIR),
    }
}

/// `[sensor.measurements controller.sensor]`: two ends with no comma, or with something else, between them.
fn separated_oddly(span: Span, text: &str, first: &str, second: &str) -> Diagnostic {
    let between =
        ["<->", "-->", "->", "=>", "<-", "→", ";", "|", "&", ":"].into_iter().find(|mark| text.contains(mark));
    let (message, label) = match between {
        Some(mark) => {
            (format!("`{mark}` does not separate the ends of a connection"), "expected a comma between the two")
        }
        None => ("a comma is missing between the ends of this connection".to_owned(), "one text, not two ends"),
    };
    let pair = format!("[{first}, {second}]");
    RULE.at(message, span, label).propose(format!("write `{pair}`"), [Edit::new(span, pair)])
}

/// `- sensor.measurements`, `- a.b -> c.d`, `- (a.b, c.d)`.
pub(in crate::parse) fn text(item: &Node, text: &str) -> Diagnostic {
    let ends = words(text);
    let arrow = text.split_whitespace().find(|word| matches!(*word, "->" | "<-" | "<->" | "=>" | "-->" | "→"));
    let label = match (arrow, ends.len()) {
        (Some(arrow), 0 | 1) => format!("one end of `{arrow}` is missing"),
        _ => "this is text".to_owned(),
    };
    let problem = RULE.at(format!("{PAIR}; this one is text"), item.span, label);
    match ends.as_slice() {
        [one] => problem.help(one_end(one)),
        [first, second] => problem.help(format!("write `[{first}, {second}]`")),
        _ => problem.help(WRITE_A_PAIR),
    }
}

/// `- sensor.measurements: controller.sensor`, `- {sensor.measurements, controller.sensor}`.
pub(in crate::parse) fn mapping(item: &Node) -> Diagnostic {
    let problem = RULE.at(format!("{PAIR}; this one is a mapping"), item.span, "a key and its value");
    let NodeKind::Mapping { entries } = &item.kind else { return problem };
    match entries.as_slice() {
        [(first, second)] => match (scalar(first), scalar(second)) {
            (Some(first), Some(second)) => problem.help(format!("write `[{}, {}]`", first.value, second.value)),
            (Some(first), None) if second.is_null() => problem.help(one_end(&first.value)),
            _ => problem.help(WRITE_A_PAIR),
        },
        [(first, nothing), (second, nothing_more)]
            if nothing.is_null()
                && nothing_more.is_null()
                && let (Some(first), Some(second)) = (scalar(first), scalar(second)) =>
        {
            RULE.at("a pair stands in brackets, not in braces", item.span, "braces")
                .help(format!("write `[{}, {}]`", first.value, second.value))
        }
        _ => problem.help(WRITE_A_PAIR),
    }
}

/// A list or mapping as one of two ends.
pub(in crate::parse) fn end_is_not_text(node: &Node) -> Diagnostic {
    let message = format!("an end of a connection is `component.gate`; this is {}", shape_word(node));
    let problem = RULE.at(message, node.span, format!("this is {}", shape_word(node)));
    if let NodeKind::Mapping { entries } = &node.kind
        && let [(component, gate)] = entries.as_slice()
        && let (Some(component), Some(gate)) = (scalar(component), scalar(gate))
    {
        return problem.help(format!("write `{}.{}`", component.value, gate.value));
    }
    problem
}

fn one_end(end: &str) -> String {
    format!("add the other end: `[{end}, component.gate]`")
}

fn pairs(first: &str, others: &[String]) -> String {
    let count = if others.len() == 2 { "two".to_owned() } else { others.len().to_string() };
    let mut help = format!("to send to {count} subscribers write {count} connections:");
    others.iter().take(SHOWN).for_each(|other| help.push_str(&format!("\n- [{first}, {other}]")));
    if others.len() > SHOWN {
        help.push_str(&format!("\nand {} more", others.len() - SHOWN));
    }
    help
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
              = help: to send to two subscribers write two connections:
                      - [controller.events, user_interface.events]
                      - [controller.events, logger.events]"#]],
        );
    }
}
