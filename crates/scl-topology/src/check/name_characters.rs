//! SCL0303: a character that no name may contain. Names become socket paths, Rust names and words of other languages.

use super::look_alike::has_foreign_letter;
use super::named::{Noun, is_allowed, names};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::source::Spanned;

/// SCL0303.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0303",
    severity: Severity::Error,
    title: "invalid character in a name",
    explanation: "Names become socket paths, Rust fields and names in other languages, so they consist of letters, \
                  digits, `_` and `-`. A dot cannot be part of one, as it separates component and gate.",
    example: " components:
-  - name: gps sensor
+  - name: gps_sensor
+    gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (noun, name) in names(model) {
        if let Some(what) = forbidden(&name.value) {
            problems.push(report(noun, name, &what));
        }
    }
}

/// What the name must not contain, in words.
fn forbidden(name: &str) -> Option<String> {
    if name.is_empty() || has_foreign_letter(name) {
        return None;
    }
    match name.chars().find(|&letter| !is_allowed(letter)) {
        Some(letter) => Some(described(letter)),
        None => name.contains("--").then(|| "two hyphens in a row".to_owned()),
    }
}

fn described(letter: char) -> String {
    match letter {
        ' ' => "a space".to_owned(),
        '.' => "a dot".to_owned(),
        '/' => "a slash".to_owned(),
        ':' => "a colon".to_owned(),
        '`' => "a backtick".to_owned(),
        other if other.is_control() => format!("a control character (U+{:04X})", u32::from(other)),
        other => format!("`{other}`"),
    }
}

fn report(noun: Noun, name: &Spanned<String>, what: &str) -> Diagnostic {
    let headline = format!("a {} name cannot contain {what}", noun.word());
    let found = RULE.at(headline, name.span, "allowed: a-z A-Z 0-9 _ -");
    let mended = mended(&name.value);
    let found = if mended.is_empty() { found } else { found.help(format!("write `{mended}`")) };
    match noun {
        Noun::System => found,
        _ if what.starts_with("two") => found.note("`--` separates the two ends in the name of a socket"),
        _ => {
            found.note("the dot separates component and gate in `component.gate`, so a name cannot contain one either")
        }
    }
}

/// The name with `_` for whatever is not allowed, none of them twice in a row or at an end.
fn mended(name: &str) -> String {
    let words = name.split(|letter: char| !letter.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    words.collect::<Vec<_>>().join("_")
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::{advice, rule_example};
    use expect_test::expect;

    #[test]
    fn invalid_character_in_a_name() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0303] a component name cannot contain a space
             --> topology.yaml:2:11
              |
            2 |   - name: gps sensor
              |           ^^^^^^^^^^ allowed: a-z A-Z 0-9 _ -
              |
              = help: write `gps_sensor`
              = note: the dot separates component and gate in `component.gate`, so a name cannot contain one either
        "#]],
        );
    }

    #[test]
    fn other_characters() {
        let names = ["a.b", "a/b", "a--b", "a+b!", "a:b"];
        let advice = |name: &str| advice(&format!("components:\n  - name: '{name}'\n    gates: []\n"));
        let told: String = names.iter().map(|name| format!("{}\n", advice(name))).collect();
        expect![[r#"
            SCL0303 a component name cannot contain a dot [write `a_b`]
            SCL0303 a component name cannot contain a slash [write `a_b`]
            SCL0303 a component name cannot contain two hyphens in a row [write `a_b`]
            SCL0303 a component name cannot contain `+` [write `a_b`]
            SCL0303 a component name cannot contain a colon [write `a_b`]
        "#]]
        .assert_eq(&told);
    }
}
