//! Names that YAML reads as something else. SCL0108: a word that YAML 1.1 reads as a boolean. SCL0109: a number.
//! SCL0119: a text block.

use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::Node;

/// SCL0108.
pub(crate) const BOOLEAN: Rule = Rule {
    code: "SCL0108",
    severity: Severity::Error,
    title: "word that YAML 1.1 reads as a boolean",
    explanation: "Older YAML tools read words such as `on` and `no` as true or false, so this name would be different \
                  in Python than in Rust. Put the word in quotes, or better, choose a name that says more.",
    example: " components:
   - name: heater
     gates:
-      - on: sub
+      - switch_on: sub
",
};

/// Words that YAML 1.1 reads as true. It lists `y` and `n` too, but the common tools do not follow it there, and `x`,
/// `y`, `z` are good names of gates.
const TRUE: [&str; 3] = ["yes", "on", "true"];
const FALSE: [&str; 3] = ["no", "off", "false"];

/// Checks a name that is written without quotes.
pub(in crate::parse) fn find_boolean(word: &str, at: Span) -> Option<Diagnostic> {
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
        BOOLEAN.at(message, at, format!("YAML 1.1 tools such as PyYAML read this as `{value}`"))
            .propose(format!("put it in quotes: `\"{word}\"`"), [Edit::new(at, format!("\"{word}\""))])
            .help("a name that is no such word needs no quotes")
            .note("a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2")
            .note(
                "PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case (\"the Norway problem\"); y and n, \
                 which YAML 1.1 lists too, are allowed",
            ),
    )
}

/// SCL0109.
pub(crate) const NUMBER: Rule = Rule {
    code: "SCL0109",
    severity: Severity::Error,
    title: "number used as a name",
    explanation: "Some YAML tools read this name as a number or a date: `1.10` would become 1.1. Start the name with a \
                  letter.",
    example: " components:
-  - name: 1.10
+  - name: v1_10
     gates: []
",
};

/// Checks a name that is written without quotes.
pub(in crate::parse) fn find_number(word: &str, at: Span) -> Option<Diagnostic> {
    let reading = reading(word)?;
    let message = format!("a name is expected here, and `{word}` is a {}", reading.noun());
    Some(
        NUMBER
            .at(message, at, reading.label(word))
            .help(format!("a name starts with a letter, as `{}` does", as_name(word)))
            .note(
                "also read as numbers by YAML 1.1 or 1.2: 017, 0o17, 0x1F, 1_000, 12:30:45 (base 60), 1e3, .inf; and \
                 dates such as 2024-01-01",
            ),
    )
}

/// A value other than text that some YAML reader takes a word for.
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

/// SCL0119.
pub(crate) const TEXT_BLOCK: Rule = Rule {
    code: "SCL0119",
    severity: Severity::Error,
    title: "text block used as a name",
    explanation: "`|` and `>` start a multi-line text, whose value ends with a line break. A name must be on one line. \
                  Write it after its key.",
    example: " components:
-  - name: |
-      sensor
+  - name: sensor
+    gates: []
",
};

pub(in crate::parse) fn text_block(node: &Node, text: &str, source: &SourceFile) -> Diagnostic {
    let end = if text.ends_with('\n') { " with a line break" } else { "" };
    let label = format!("this starts a text block; its value is {text:?}{end}");
    let problem = TEXT_BLOCK.at("a name must be written on one line", header(node, source), label);
    let name = text.trim();
    if name.contains('\n') {
        return problem;
    }
    let block = header(node, source).to(node.span);
    // The block includes its last line break, which the fix keeps.
    let whole = source.snippet(block);
    let end = block.start + whole.trim_end().len() as u32;
    let help = format!("write `{}`", written(node, name, source));
    problem.propose(help, [Edit::new(Span { end, ..block }, name)])
}

/// The `|` or `>`, in the line above the text.
fn header(node: &Node, source: &SourceFile) -> Span {
    let before = source.text().get(..node.span.start as usize).unwrap_or("").trim_end();
    let line = source.line_range(before.len()).start;
    let found = before.get(line..).and_then(|above| above.find(['|', '>']));
    found.map_or(node.span, |at| {
        let start = (line + at) as u32;
        Span { start, end: start + 1, ..node.span }
    })
}

/// The key of the header's line, and the name after it.
fn written(node: &Node, name: &str, source: &SourceFile) -> String {
    let header = header(node, source).start as usize;
    let line = source.line_range(header).start;
    let before = source.text().get(line..header).unwrap_or("");
    format!("{}{name}", before.trim_start_matches([' ', '-']))
}

#[cfg(test)]
mod tests {
    use super::{BOOLEAN, NUMBER, TEXT_BLOCK};
    use crate::parse::testing::check;
    use expect_test::expect;

    #[test]
    fn boolean_word() {
        check(
            &BOOLEAN,
            expect![[r#"
                error: [SCL0108] `on` is a boolean in YAML 1.1
                 --> topology.yaml:4:9
                  |
                4 |       - on: sub
                  |         ^^ YAML 1.1 tools such as PyYAML read this as `true`
                  |
                  = help: put it in quotes: `"on"`
                  = help: a name that is no such word needs no quotes
                  = note: a topology file is read by bindings in several languages, so it must mean the same in YAML 1.1 and 1.2
                  = note: PyYAML: yes, no, on, off, true, false in lower, Title and UPPER case ("the Norway problem"); y and n, which YAML 1.1 lists too, are allowed"#]],
        );
    }

    #[test]
    fn number_as_name() {
        check(
            &NUMBER,
            expect![[r#"
                error: [SCL0109] a name is expected here, and `1.10` is a number
                 --> topology.yaml:2:11
                  |
                2 |   - name: 1.10
                  |           ^^^^ YAML reads this as the number 1.1
                  |
                  = help: a name starts with a letter, as `v1_10` does
                  = note: also read as numbers by YAML 1.1 or 1.2: 017, 0o17, 0x1F, 1_000, 12:30:45 (base 60), 1e3, .inf; and dates such as 2024-01-01"#]],
        );
    }

    #[test]
    fn text_block_as_name() {
        check(
            &TEXT_BLOCK,
            expect![[r#"
            error: [SCL0119] a name must be written on one line
             --> topology.yaml:2:11
              |
            2 |   - name: |
              |           ^ this starts a text block; its value is "sensor\n" with a line break
              |
              = help: write `name: sensor`"#]],
        );
    }
}
