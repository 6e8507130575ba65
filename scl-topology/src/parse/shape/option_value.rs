//! SCL0215: a value of the wrong kind.

use super::ticked;
use crate::catalogue::{Examples, Rule};
use crate::diagnostic::Diagnostic;
use crate::diagnostic::Severity;
use crate::parse::fields::Field;
use crate::parse::option::Value;
use crate::parse::{is_plain, shape_word};
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};

/// SCL0215.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0215",
    severity: Severity::Error,
    title: "option value has the wrong kind",
    explanation: "The value has the wrong type: text where a number belongs, a number without a unit where a duration \
                  belongs, or a word that the option does not know. The message gives an example.",
    examples: Examples::Topology {
        bad: "components:
  - name: sensor
    gates:
      - measurements: {pub: Measurement, queue: many}
",
        good: "components:
  - name: sensor
    gates:
      - measurements: {sub: Measurement, queue: 16}
",
    },
};

pub(in crate::parse) fn diagnose(field: Field<'_>, expected: Value) -> Diagnostic {
    let key = field.key;
    let (rule, example) = match expected {
        Value::Number if key == "scl" => ("a whole number".to_owned(), "1"),
        Value::Number => ("a whole number".to_owned(), "16"),
        Value::Duration => ("a number and a unit: `us`, `ms` or `s`".to_owned(), "500ms"),
        Value::Boolean => ("`true` or `false`".to_owned(), "true"),
        Value::Word(words) => (one_of(words), words.first().copied().unwrap_or("")),
        Value::Text | Value::Name => ("text".to_owned(), "text"),
    };
    let problem = RULE.at(format!("`{key}` must be {rule}"), field.value.span, label(field.value));
    problem.help(match meant(field.value, expected) {
        Some(word) => format!("write `{key}: {word}`"),
        None => format!("for example `{key}: {example}`"),
    })
}

/// A list or mapping where text belongs; `place` is where, for example `` `name` ``.
pub(in crate::parse) fn not_text(place: &str, node: &Node) -> Diagnostic {
    let message = format!("{place} must be text; this is {}", shape_word(node));
    RULE.at(message, node.span, format!("this is {}", shape_word(node)))
}

fn one_of(words: &[&str]) -> String {
    match words {
        [rest @ .., last] if !rest.is_empty() => format!("{} or `{last}`", ticked(rest.iter().copied())),
        _ => ticked(words.iter().copied()),
    }
}

fn label(value: &Node) -> String {
    match &value.kind {
        NodeKind::Scalar { .. } if !is_plain(value) => "this is text, because of the quotes".to_owned(),
        NodeKind::Scalar { text, .. } if text.parse::<i64>().is_ok() => "this is a number without a unit".to_owned(),
        NodeKind::Scalar { text, .. } if text.parse::<f64>().is_ok() => "this is not a whole number".to_owned(),
        _ => format!("this is {}", shape_word(value)),
    }
}

/// The value without its quotes, or a word that is nearly right.
fn meant(value: &Node, expected: Value) -> Option<String> {
    let NodeKind::Scalar { text, .. } = &value.kind else { return None };
    let words: &[&str] = match expected {
        Value::Number => return (!is_plain(value) && text.parse::<u32>().is_ok()).then(|| text.clone()),
        Value::Boolean => &["true", "false"],
        Value::Word(words) => words,
        // A bare number is most probably meant as milliseconds.
        Value::Duration => return text.parse::<u32>().is_ok().then(|| format!("{text}ms")),
        Value::Text | Value::Name => return None,
    };
    match text.to_ascii_lowercase().as_str() {
        "yes" | "on" if words.contains(&"true") => Some("true".to_owned()),
        "no" | "off" if words.contains(&"false") => Some("false".to_owned()),
        lower if words.contains(&lower) => Some(lower.to_owned()),
        lower => similar(lower, words.iter().copied()).first().map(|word| (*word).to_owned()),
    }
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
            error: [SCL0215] `queue` must be a whole number
             --> topology.yaml:4:49
              |
            4 |       - measurements: {pub: Measurement, queue: many}
              |                                                 ^^^^ this is text
              |
              = help: for example `queue: 16`"#]],
        );
    }
}
