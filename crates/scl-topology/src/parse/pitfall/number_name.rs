//! SCL0109: a number where a name belongs.

use crate::diagnostic::{Diagnostic, Rule, Severity};
use crate::source::Span;

/// SCL0109.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0109",
    severity: Severity::Error,
    title: "number used as a name",
    explanation: "Where a name belongs stands a number or a date, as some YAML tools read it: `1.10` would become 1.1. \
                  Start the name with a letter.",
    example: " components:
-  - name: 1.10
+  - name: v1_10
     gates: []
",
};

/// Looks at a name that stands without quotes.
pub(in crate::parse) fn find(word: &str, at: Span) -> Option<Diagnostic> {
    let reading = reading(word)?;
    let message = format!("a name is expected here, and `{word}` is a {}", reading.noun());
    Some(
        RULE.at(message, at, reading.label(word)).help(format!("names start with a letter: `{}`", as_name(word))).note(
            "also read as numbers by YAML 1.1 or 1.2: 017, 0o17, 0x1F, 1_000, 12:30:45 (base 60), 1e3, .inf; and \
                 dates such as 2024-01-01",
        ),
    )
}

/// What some YAML reader makes of a word.
enum Reading {
    Number(Option<f64>),
    Sexagesimal,
    Date,
}

impl Reading {
    fn noun(&self) -> &'static str {
        match self {
            Reading::Date => "date",
            _ => "number",
        }
    }

    fn label(&self, word: &str) -> String {
        match self {
            Reading::Number(Some(value)) if value.to_string() != word => {
                format!("YAML reads this as the number {value}")
            }
            Reading::Number(_) => "YAML reads this as a number".to_owned(),
            Reading::Sexagesimal => "YAML 1.1 reads this as a number of base 60".to_owned(),
            Reading::Date => "YAML 1.1 reads this as a date".to_owned(),
        }
    }
}

fn reading(word: &str) -> Option<Reading> {
    let digits = word.strip_prefix(['-', '+']).unwrap_or(word);
    let lower = digits.to_ascii_lowercase();
    if matches!(lower.as_str(), ".inf" | ".nan") {
        return Some(Reading::Number(None));
    }
    if !lower.starts_with(|first: char| first.is_ascii_digit() || first == '.') {
        return None;
    }
    if is_prefixed(&lower) {
        return Some(Reading::Number(None));
    }
    if is_date(&lower) {
        return Some(Reading::Date);
    }
    let parts: Vec<&str> = lower.split(':').collect();
    if parts.len() > 1 && parts.iter().all(|part| !part.is_empty() && only(part, "0123456789_.")) {
        return Some(Reading::Sexagesimal);
    }
    let value = lower.replace('_', "").parse::<f64>().ok()?;
    let octal = lower.len() > 1 && lower.starts_with('0') && only(&lower, "0123456789");
    Some(Reading::Number((!octal && word == digits).then_some(value)))
}

/// `0x1f`, `0o17`, `0b1`.
fn is_prefixed(word: &str) -> bool {
    [("0x", "0123456789abcdef_"), ("0o", "01234567"), ("0b", "01_")]
        .iter()
        .filter_map(|(prefix, digits)| word.strip_prefix(prefix).map(|rest| (rest, digits)))
        .any(|(rest, digits)| !rest.is_empty() && only(rest, digits))
}

fn is_date(word: &str) -> bool {
    let date = word.split(['t', ' ']).next().unwrap_or(word);
    let parts: Vec<&str> = date.split('-').collect();
    matches!(parts.as_slice(), [year, month, day] if year.len() == 4
        && [year, month, day].iter().all(|part| matches!(part.len(), 1..=4) && only(part, "0123456789")))
}

fn only(word: &str, letters: &str) -> bool {
    word.chars().all(|letter| letters.contains(letter))
}

fn as_name(word: &str) -> String {
    let rest: String = word.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    format!("v{}", rest.trim_matches('_'))
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
            error: [SCL0109] a name is expected here, and `1.10` is a number
             --> topology.yaml:2:11
              |
            2 |   - name: 1.10
              |           ^^^^ YAML reads this as the number 1.1
              |
              = help: names start with a letter: `v1_10`
              = note: also read as numbers by YAML 1.1 or 1.2: 017, 0o17, 0x1F, 1_000, 12:30:45 (base 60), 1e3, .inf; and dates such as 2024-01-01"#]],
        );
    }
}
