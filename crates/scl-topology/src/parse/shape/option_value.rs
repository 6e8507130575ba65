//! SCL0215: a value of the wrong kind.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::grammar::{self, Shape};
use crate::parse::field::Field;
use crate::parse::shape_word;
use crate::suggest::similar;
use crate::yaml::{Node, NodeKind};
use scl_text::size;

/// SCL0215.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0215",
    severity: Severity::Error,
    title: "option value has the wrong kind",
    explanation: "The value has the wrong type: text where a number belongs, a number without a unit where a duration \
                  or a size belongs, or a word that the option does not know. The message gives an example.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {pub: Measurement, queue: many}
+      - measurements: {sub: Measurement, queue: 16}
",
};

pub(in crate::parse) fn diagnose(field: Field<'_>, expected: Shape) -> Diagnostic {
    let key = field.key;
    let problem =
        RULE.at(format!("`{key}` must be {}", expected.rule()), field.value.span, label(field.value, expected));
    let meant: Vec<String> = meant(field.value, expected).iter().map(|value| format!("`{key}: {value}`")).collect();
    problem.help(match meant.is_empty() {
        true => format!("for example `{key}: {}`", example(key, expected)),
        false => format!("write {}", meant.join(" or ")),
    })
}

/// A value that the key could have.
fn example(key: &str, expected: Shape) -> String {
    match (grammar::option(key), expected) {
        (Some(option), _) => option.example().to_owned(),
        (None, Shape::Number { least, .. }) => least.to_string(),
        _ => "true".to_owned(),
    }
}

/// A list or mapping where text belongs; `place` is where, for example `` `name` ``.
pub(in crate::parse) fn not_text(place: &str, node: &Node) -> Diagnostic {
    let message = format!("{place} must be text; this is {}", shape_word(node));
    RULE.at(message, node.span, format!("this is {}", shape_word(node)))
}

fn label(value: &Node, expected: Shape) -> String {
    let is_size = matches!(expected, Shape::Size { .. });
    match &value.kind {
        // Quotes are not the mistake here: a quoted size with a unit is valid.
        NodeKind::Scalar { text, .. } if is_size && text.parse::<i64>().is_ok() => {
            "this is a number without a unit".to_owned()
        }
        NodeKind::Scalar { .. } if is_size => "this is not a size".to_owned(),
        NodeKind::Scalar { .. } if !value.is_plain() => "this is text, because of the quotes".to_owned(),
        NodeKind::Scalar { text, .. } if text.parse::<i64>().is_ok() => "this is a number without a unit".to_owned(),
        NodeKind::Scalar { text, .. } if text.parse::<f64>().is_ok() => "this is not a whole number".to_owned(),
        _ => format!("this is {}", shape_word(value)),
    }
}

/// The value without its quotes, or words that are nearly right.
fn meant(value: &Node, expected: Shape) -> Vec<String> {
    let NodeKind::Scalar { text, .. } = &value.kind else { return Vec::new() };
    let words: Vec<&str> = match expected {
        Shape::Number { .. } if !value.is_plain() && text.parse::<u32>().is_ok() => return vec![text.clone()],
        // A number without a unit was probably meant in milliseconds.
        Shape::Duration { .. } if text.parse::<u32>().is_ok() => return vec![format!("{text}ms")],
        Shape::Size { .. } => return size::suggestions(text),
        Shape::Boolean => vec!["true", "false"],
        Shape::Word(words) => words.iter().map(|known| known.word).collect(),
        _ => return Vec::new(),
    };
    let word = match text.to_ascii_lowercase().as_str() {
        "yes" | "on" if words.contains(&"true") => Some("true".to_owned()),
        "no" | "off" if words.contains(&"false") => Some("false".to_owned()),
        lower if words.contains(&lower) => Some(lower.to_owned()),
        lower => similar(lower, words.iter().copied()).first().map(|word| (*word).to_owned()),
    };
    word.into_iter().collect()
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::parse::testing::{check, parse_text};
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
                  = help: for example `queue: 1`"#]],
        );
    }

    #[test]
    fn sizes_need_a_unit_of_ours() {
        let sizes = ["65536", "\"65536\"", "8", "8MB", "\"8 mb\"", "1.5GiB", "1TiB", "large", "0x10", "[8MiB]", "true"];
        let told = sizes.map(|size| {
            let yaml =
                format!("components: [{{name: a, gates: [{{x: {{sub: T, max_size: {size}}}}}]}}]\nconnections: []\n");
            let (_, found, _) = parse_text(&yaml);
            let told = found.iter().map(|found| {
                let label = found.primary.as_ref().map_or("", |label| label.text.as_str());
                let helps: Vec<_> = found.shown_helps().map(|help| help.text().into_owned()).collect();
                format!("{size}: {} {label} {helps:?}\n", found.message)
            });
            told.collect::<String>()
        });
        expect![[r#"
            65536: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a number without a unit ["write `max_size: 65536B` or `max_size: 64KiB`"]
            "65536": `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a number without a unit ["write `max_size: 65536B` or `max_size: 64KiB`"]
            8: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a number without a unit ["write `max_size: 8MiB` or `max_size: 8KiB` or `max_size: 8B`"]
            8MB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 8MiB`"]
            "8 mb": `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 8MiB`"]
            1.5GiB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 1536MiB`"]
            1TiB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["for example `max_size: 8MiB`"]
            large: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["for example `max_size: 8MiB`"]
            0x10: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["for example `max_size: 8MiB`"]
            [8MiB]: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a list ["for example `max_size: 8MiB`"]
            true: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["for example `max_size: 8MiB`"]
        "#]].assert_eq(&told.concat());
    }
}
