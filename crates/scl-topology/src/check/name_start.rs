//! SCL0305: a name that starts with a digit or a hyphen. No programming language can spell it.

use super::named::{Noun, is_allowed, may_start, names};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::source::Spanned;

/// SCL0305.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0305",
    severity: Severity::Error,
    title: "name starts with the wrong character",
    explanation: "A name starts with a letter or `_`, as in every programming language that will use it. Put a word \
                  first.",
    example: " components:
-  - name: 2nd_sensor
+  - name: second_sensor
+    gates: []
",
};

const ORDINALS: [(&str, &str); 9] = [
    ("1st", "first"),
    ("2nd", "second"),
    ("3rd", "third"),
    ("4th", "fourth"),
    ("5th", "fifth"),
    ("6th", "sixth"),
    ("7th", "seventh"),
    ("8th", "eighth"),
    ("9th", "ninth"),
];

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        let first = name.value.chars().next();
        let spelt = name.value.chars().all(is_allowed) && !name.value.contains("--");
        if let Some(first) = first.filter(|&first| spelt && !may_start(first)) {
            problems.push(report(noun, name, first));
        }
    }
}

fn report(noun: Noun, name: &Spanned<String>, first: char) -> Diagnostic {
    let headline = format!("a {} name must start with a letter", noun.word());
    let start = if first == '-' { "starts with a hyphen" } else { "starts with a digit" };
    let found = RULE.at(headline, name.span, start);
    match alternatives(&name.value) {
        Some(ways) => found.help(format!("for example {ways}")),
        None => found.help("put a word before it"),
    }
}

/// `2nd_sensor` could be `second_sensor` or `sensor_2`.
fn alternatives(name: &str) -> Option<String> {
    let digits: String = name.chars().take_while(char::is_ascii_digit).collect();
    let ordinal = ORDINALS.iter().find(|(short, _)| name.starts_with(short));
    let rest = ordinal.map_or(&name[digits.len()..], |(short, _)| &name[short.len()..]);
    let rest = rest.trim_matches(['_', '-']);
    let moved = match (rest.is_empty(), digits.is_empty()) {
        (true, _) => return None,
        (false, true) => format!("`{rest}`"),
        (false, false) => format!("`{rest}_{digits}`"),
    };
    Some(match ordinal {
        Some((_, word)) => format!("`{word}_{rest}` or {moved}"),
        None => moved,
    })
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn name_starts_with_the_wrong_character() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0305] a component name must start with a letter
             --> topology.yaml:2:11
              |
            2 |   - name: 2nd_sensor
              |           ^^^^^^^^^^ starts with a digit
              |
              = help: for example `second_sensor` or `sensor_2`
        "#]],
        );
    }

    #[test]
    fn other_starts() {
        let names = ["3sensors", "4", "-left", "1st-row"];
        let advice = |name: &str| advice(&format!("components:\n  - name: '{name}'\n    gates: []\n"));
        let told: String = names.iter().map(|name| format!("{}\n", advice(name))).collect();
        expect![[r#"
            SCL0305 a component name must start with a letter [for example `sensors_3`]
            SCL0305 a component name must start with a letter [put a word before it]
            SCL0305 a component name must start with a letter [for example `left`]
            SCL0305 a component name must start with a letter [for example `first_row` or `row_1`]
        "#]]
        .assert_eq(&told);
    }
}
