//! SCL0110: nothing where a name or value is expected.

use crate::diagnostic::{Diagnostic, Rule, Severity, removal};
use crate::parse::field::{Field, end_with_colon};
use crate::parse::with_dash;
use crate::source::{SourceFile, Span};
use crate::yaml::Node;

/// SCL0110.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0110",
    severity: Severity::Error,
    title: "missing name or value",
    explanation: "A key has no value where one is needed; YAML reads this as null. Write the value after the colon. \
                  Only the type of a gate may be left empty: `events: {pub: , queue: 1}` is a gate with options but \
                  without a type.",
    example: " components:
-  - name:
+  - name: sensor
     gates: []
",
};

/// `key:` without a value; `what` is what the value would be, for example `component name`.
pub(in crate::parse) fn in_field(field: Field<'_>, what: &str, source: &SourceFile) -> Diagnostic {
    let key = field.key;
    let is_written = field.value.span.start < field.value.span.end;
    let (span, label) = match is_written {
        true => (field.value.span, value_label(field.value)),
        false => {
            let end = end_with_colon(field.key_span, source);
            (Span { end, ..field.key_span }, "no value follows; YAML reads this as `null`")
        }
    };
    let help = match key {
        "name" => "the name follows the colon".to_owned(),
        _ => "a value follows the colon".to_owned(),
    };
    let entry = Span { end: field.value.span.end.max(end_with_colon(field.key_span, source)), ..field.key_span };
    let is_unfinished = !is_written || field.value.is_null();
    let problem = diagnose(what, span, label);
    let problem = if is_unfinished { problem.help(&*help) } else { problem };
    let problem = match removal(source, entry).filter(|_| key != "name") {
        // Empty quotes are written by programs; a key without anything may be unfinished.
        Some(removed) if !is_unfinished => problem.propose(format!("remove `{key}`"), [removed]),
        Some(removed) => problem.suggest(format!("remove `{key}`"), [removed]),
        None => problem,
    };
    problem.note("`~` and `null` are also read as \"no value\"")
}

/// `-` without an item.
pub(in crate::parse) fn in_list(item: &Node, what: &str, source: &SourceFile) -> Diagnostic {
    let span = with_dash(item.span, source);
    let label =
        if item.span.start < item.span.end { value_label(item) } else { "nothing follows; YAML reads this as `null`" };
    let problem = diagnose(what, span, label);
    let problem = match removal(source, span) {
        Some(removed) => problem.suggest("remove this entry", [removed]),
        None => problem,
    };
    problem.otherwise("an item follows the `-`").note("`~` and `null` are also read as \"no value\"")
}

fn diagnose(what: &str, span: Span, label: &str) -> Diagnostic {
    RULE.at(format!("the {what} is empty"), span, label)
}

fn value_label(value: &Node) -> &'static str {
    if value.is_null() { "YAML reads this as \"no value\"" } else { "nothing between the quotes" }
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
                error: [SCL0110] the component name is empty
                 --> topology.yaml:2:5
                  |
                2 |   - name:
                  |     ^^^^^ no value follows; YAML reads this as `null`
                  |
                  = help: the name follows the colon
                  = note: `~` and `null` are also read as "no value""#]],
        );
    }
}
