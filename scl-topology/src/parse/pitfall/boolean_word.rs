//! SCL0108: a word that YAML 1.1 reads as a boolean.

use crate::diagnostic::Diagnostic;
use crate::source::Span;

const TRUE: [&str; 4] = ["yes", "on", "true", "y"];
const FALSE: [&str; 4] = ["no", "off", "false", "n"];

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
    let reader = if lower.len() == 1 { "the YAML 1.1 standard reads" } else { "YAML 1.1 tools such as PyYAML read" };
    let message = format!("`{word}` is a boolean in YAML 1.1");
    Some(
        Diagnostic::error("SCL0108", message, at, format!("{reader} this as `{value}`"))
            .help(format!("quote it: \"{word}\""))
            .help(format!("or choose a name that says more: `{}`", better(&lower)))
            .note("a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2")
            .note(
                "PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case; YAML 1.1 also lists y and n \
                 (\"the Norway problem\")",
            ),
    )
}

fn better(word: &str) -> &'static str {
    match word {
        "on" | "off" => "switch_on",
        "y" => "position_y",
        "n" => "count",
        "yes" | "true" => "confirmed",
        _ => "rejected",
    }
}

#[cfg(test)]
mod tests {
    use crate::parse::testing::check;
    use expect_test::expect;

    const EXAMPLE: &str = "components:
  - name: heater
    gates:
      - on: sub
";

    #[test]
    fn example() {
        check(
            "SCL0108",
            EXAMPLE,
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
              = note: PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case; YAML 1.1 also lists y and n ("the Norway problem")"#]],
        );
    }
}
