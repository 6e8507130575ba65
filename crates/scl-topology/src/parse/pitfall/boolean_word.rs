//! SCL0108: a word that YAML 1.1 reads as a boolean.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::Span;

/// SCL0108.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0108",
    severity: Severity::Error,
    title: "word that YAML 1.1 reads as a boolean",
    explanation: "Older YAML tools read words such as `on` and `no` as true or false, so a gate of this name \
                  would have another name in Python than in Rust. Put the word in quotes, or better choose a name that \
                  says more.",
    example: " components:
   - name: heater
     gates:
-      - on: sub
+      - switch_on: sub
",
};

/// YAML 1.1 lists `y` and `n` too, but no usual tool follows it there, and `x`, `y`, `z` are good names of gates.
const TRUE: [&str; 3] = ["yes", "on", "true"];
const FALSE: [&str; 3] = ["no", "off", "false"];

/// Looks at a name that stands without quotes.
pub(in crate::parse) fn find(word: &str, at: Span) -> Option<Diagnostic> {
    let lower = word.to_ascii_lowercase();
    let is_title = word.get(1..).is_some_and(|rest| rest == &lower[1..]);
    if !(is_title || word == word.to_ascii_uppercase()) {
        return None;
    }
    let value = match lower.as_str() {
        word if TRUE.contains(&word) => "true",
        word if FALSE.contains(&word) => "false",
        _ => return None,
    };
    let message = format!("`{word}` is a boolean in YAML 1.1");
    Some(
        RULE.at(message, at, format!("YAML 1.1 tools such as PyYAML read this as `{value}`"))
            .help(format!("quote it: \"{word}\""))
            .help(format!("or choose a name that says more: `{}`", better(&lower)))
            .note("a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2")
            .note(
                "PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case (\"the Norway problem\"); y and n, \
                 which YAML 1.1 lists too, are allowed",
            ),
    )
}

fn better(word: &str) -> &'static str {
    match word {
        "on" | "off" => "switch_on",
        "yes" | "true" => "confirmed",
        _ => "rejected",
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
                error: [SCL0108] `on` is a boolean in YAML 1.1
                 --> topology.yaml:4:9
                  |
                4 |       - on: sub
                  |         ^^ YAML 1.1 tools such as PyYAML read this as `true`
                  |
                  = help: quote it: "on"
                  = help: or choose a name that says more: `switch_on`
                  = note: a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2
                  = note: PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case ("the Norway problem"); y and n, which YAML 1.1 lists too, are allowed"#]],
        );
    }
}
