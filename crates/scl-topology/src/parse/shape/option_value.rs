//! SCL0215: a value of the wrong kind.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity, removal};
use crate::grammar::{GateOption, Shape, option};
use crate::habits;
use crate::parse::field::{Field, end_with_colon};
use crate::parse::meant::{Meant, meant};
use crate::parse::shape_word;
use crate::source::{SourceFile, Span};
use crate::yaml::{Node, NodeKind};

/// SCL0215.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0215",
    severity: Severity::Error,
    title: "option value has the wrong kind",
    explanation: "The value has the wrong type: text where a number belongs, a number without a unit where a duration \
                  or a size belongs, or a word that the option does not know. The message says what is allowed.",
    example: " components:
   - name: sensor
     gates:
-      - measurements: {sub: Measurement, queue: many}
+      - measurements: {sub: Measurement, queue: 16}
",
};

pub(in crate::parse) fn diagnose(field: Field<'_>, expected: Shape, source: &SourceFile) -> Diagnostic {
    let key = field.key;
    let problem =
        RULE.at(format!("`{key}` must be {}", expected.rule()), field.value.span, label(field.value, expected));
    let problem = with_meant(problem, field, meant(key, field.value, expected));
    let words = field.value.text().and_then(|text| habits::of_value(key, text)).map_or("", |habit| habit.text);
    if let (false, Some(largest)) = (words.is_empty() || problem.proposals().next().is_some(), expected.largest()) {
        let text = format!("{words}; the largest is `{key}: {largest}`");
        return with_default(problem.suggest(text, [replacement(field, &largest)]), field, source);
    }
    match words {
        "" => problem.otherwise(format!("allowed: {}", expected.values())),
        words => problem.otherwise(format!("{words}; allowed: {}", expected.values())),
    }
}

/// A group of pullers in the place of the length of the queue of one.
pub(in crate::parse) fn group(field: Field<'_>, source: &SourceFile) -> Diagnostic {
    let problem = RULE.at("`queue` is a number of messages, not the name of a group", field.value.span, "a name");
    let problem =
        problem.help("all pullers of a `push` gate with `share: true` share its work, so no group has a name");
    with_default(problem, field, source)
}

/// Suggests leaving an option out.
fn with_default(problem: Diagnostic, field: Field<'_>, source: &SourceFile) -> Diagnostic {
    let default = option(field.key).and_then(GateOption::default);
    match (default, removal(source, field.key_span.to(field.value.span))) {
        (Some(default), Some(removed)) => problem.suggest(format!("without it, the default is {default}"), [removed]),
        _ => problem,
    }
}

fn with_meant(problem: Diagnostic, field: Field<'_>, meant: Meant) -> Diagnostic {
    let entries: Vec<String> = meant.values.iter().map(|value| format!("{}: {value}", field.key)).collect();
    match entries.as_slice() {
        [only] if !meant.is_certain => {
            problem.suggest(format!("write `{only}`"), [replacement(field, &meant.values[0])])
        }
        entries => {
            let edits = meant.values.iter().map(|value| replacement(field, value));
            problem.choose(("write ", ""), entries.iter().map(String::as_str).zip(edits))
        }
    }
}

/// The change that gives a key another value.
pub(in crate::parse) fn replacement(field: Field<'_>, value: &str) -> Edit {
    match field.value.kind {
        NodeKind::Scalar { .. } => Edit::new(field.value.span, value),
        // A list or mapping may start on another line.
        _ => Edit::new(Span { start: field.key_span.end, ..field.value.span }, format!(": {value}")),
    }
}

/// The change that gives a key without a value one.
pub(in crate::parse) fn filled(field: Field<'_>, value: &str, source: &SourceFile) -> Edit {
    if field.value.span.start < field.value.span.end {
        return replacement(field, value);
    }
    let start = end_with_colon(field.key_span, source);
    let behind = source.text().get(start as usize..).unwrap_or("");
    let spaces = behind.len() - behind.trim_start_matches(' ').len();
    // Spaces before a comment stay.
    let spaces = if behind[spaces..].starts_with([',', '}']) { spaces as u32 } else { 0 };
    Edit::new(Span { start, end: start + spaces, ..field.key_span }, format!(" {value}"))
}

/// A list or mapping where text belongs; `place` is where, for example `` `name` ``.
pub(in crate::parse) fn not_text(place: &str, node: &Node) -> Diagnostic {
    let message = format!("{place} must be text; this is {}", shape_word(node));
    RULE.at(message, node.span, format!("this is {}", shape_word(node)))
}

fn label(value: &Node, expected: Shape) -> String {
    let is_size = matches!(expected, Shape::Size { .. });
    let has_unit = matches!(expected, Shape::Duration { .. } | Shape::Rate { .. });
    match &value.kind {
        // Quotes are not the mistake here: a quoted size with a unit is valid.
        NodeKind::Scalar { text, .. } if is_size && text.parse::<i64>().is_ok() => {
            "this is a number without a unit".to_owned()
        }
        NodeKind::Scalar { .. } if is_size => "this is not a size".to_owned(),
        NodeKind::Scalar { text, .. } if !value.is_plain() && expected.fits(text, true) => {
            "this is text, because of the quotes".to_owned()
        }
        NodeKind::Scalar { text, .. } if text.parse::<i64>().is_ok() || has_unit && text.parse::<f64>().is_ok() => {
            "this is a number without a unit".to_owned()
        }
        NodeKind::Scalar { text, .. } if text.parse::<f64>().is_ok() => "this is not a whole number".to_owned(),
        _ => format!("this is {}", shape_word(value)),
    }
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
                4 |       - measurements: {sub: Measurement, queue: many}
                  |                                                 ^^^^ this is text
                  |
                  = help: allowed: 1 to 1000000"#]],
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
            8: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a number without a unit ["write `max_size: 8MiB`, `max_size: 8KiB` or `max_size: 8B`"]
            8MB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 8MiB`"]
            "8 mb": `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 8MiB`"]
            1.5GiB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 1536MiB`"]
            1TiB: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["allowed: 1B to 1GiB (units: `B`, `KiB`, `MiB`, `GiB`)"]
            large: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["allowed: 1B to 1GiB (units: `B`, `KiB`, `MiB`, `GiB`)"]
            0x10: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["write `max_size: 16MiB`, `max_size: 16KiB` or `max_size: 16B`"]
            [8MiB]: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is a list ["write `max_size: 8MiB`"]
            true: `max_size` must be a whole number and a unit: `B`, `KiB`, `MiB` or `GiB` this is not a size ["allowed: 1B to 1GiB (units: `B`, `KiB`, `MiB`, `GiB`)"]
        "#]].assert_eq(&told.concat());
    }

    #[test]
    fn there_is_no_unlimited_timeout() {
        for timeout in ["0", "\"0\"", "0.0", "-1", "forever", "infinite", "K_FOREVER", "none", "false"] {
            let gate = format!("x: {{req: A -> B, timeout: {timeout}}}");
            let (_, found, _) = parse_text(&format!("components: [{{name: a, gates: [{gate}]}}]\nconnections: []\n"));
            let helps: Vec<_> =
                found.iter().flat_map(|found| found.shown_helps()).map(|help| help.text().into_owned()).collect();
            let largest = "a call always ends: there is no unlimited timeout; the largest is `timeout: 24h`";
            assert_eq!(helps, [largest, "without it, the default is 1s"], "{timeout}");
        }
    }

    #[test]
    fn a_queue_is_no_group() {
        let (_, found, _) =
            parse_text("components: [{name: a, gates: [x: {pull: T, queue: workers}]}]\nconnections: []\n");
        let messages: Vec<&str> = found.iter().map(|found| found.message.as_str()).collect();
        assert_eq!(messages, ["`queue` is a number of messages, not the name of a group"]);
    }
}
