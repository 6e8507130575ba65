//! SCL0127: a character that looks like a mark of YAML but is not. SCL0304: a letter of another script that looks like
//! an ASCII letter.

use crate::confusable;
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::source::{SourceFile, Span};
use crate::yaml::Node;
use std::ops::Range;

/// SCL0127.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0127",
    severity: Severity::Error,
    title: "character that looks like YAML punctuation",
    explanation: "Word processors and some keyboards insert colons, commas, quotes and dashes that YAML does not know: \
                  fullwidth punctuation, curly quotes, long dashes. YAML reads them as letters. Retype the character.",
    example: " components:
-  – name: sensor
+  - name: sensor
     gates: []
",
};

/// SCL0304.
pub(crate) const LETTER: Rule = Rule {
    code: "SCL0304",
    severity: Severity::Error,
    title: "look-alike character in a name",
    explanation: "The name contains a letter that is not ASCII, perhaps one that looks exactly like an ASCII letter: \
                  two names could look the same and still differ. Retype it.",
    example: " components:
-  - name: sеnsor
+  - name: sensor
+    gates: []
",
};

/// The characters of a text that look like a mark: place, character, mark.
pub(in crate::parse) fn marks(text: &str) -> impl Iterator<Item = (usize, char, &'static str)> {
    let letters = text.char_indices().filter(|(_, letter)| !letter.is_ascii());
    letters.filter_map(|(at, letter)| Some((at, letter, confusable::mark(letter)?.1)))
}

/// The problem of a character that looks like a mark, and is replaced by the mark, perhaps with a space.
pub(in crate::parse) fn diagnose(mark: &Range<usize>, with: &str, source: &SourceFile) -> Diagnostic {
    let text = source.text();
    let letter = text[mark.clone()].chars().next().unwrap_or(' ');
    let line = source.line_range(mark.start);
    let key = text[line.start..mark.start].trim_start_matches([' ', '-']);
    let value = text[mark.end..line.end].trim_end();
    match with {
        ": " if key.len() + value.len() <= MOST_SHOWN => {
            look_alike_mark(letter, format!("write `{key}: {value}`"), source.span(mark.clone()))
        }
        _ => look_alike_mark(letter, retype(with), source.span(mark.clone())),
    }
}

/// Maximum length of an entry that a help repeats, in bytes.
const MOST_SHOWN: usize = 80;

/// The first such character of a word; `what` is the word's part in a message, for example `gate name`.
pub(in crate::parse) fn in_word(node: &Node, text: &str, what: &str, source: &SourceFile) -> Option<Diagnostic> {
    let (_, letter) = confusable::first(text)?;
    let written = source.snippet(node.span);
    let span = match written.find(letter) {
        Some(at) => {
            let start = node.span.start + at as u32;
            Span { start, end: start + letter.len_utf8() as u32, ..node.span }
        }
        None => node.span,
    };
    let problem = match confusable::twin(letter) {
        Some((script, twin)) => {
            let word = text.lines().next().unwrap_or("");
            let code = u32::from(letter);
            let message = format!(
                "{what} `{word}` contains the {script} letter `{letter}` (U+{code:04X}), which looks like `{twin}`"
            );
            let problem = LETTER.at(&*message, node.span, format!("not the Latin `{twin}`")).about(&*message);
            let retyped = confusable::retyped(word);
            match what.starts_with("the ") {
                true => problem.help(format!("retype it: `{retyped}`")),
                false => problem
                    .help(format!("retype the name in ASCII: `{retyped}`"))
                    .note("names are ASCII, so that the file, the socket paths and all language bindings agree"),
            }
        }
        None => look_alike_mark(letter, retype(confusable::mark(letter).map_or("", |(_, mark)| mark)), span),
    };
    // The value of a quoted or multi-line text differs from its source, so there is no fix.
    let retyped = confusable::retyped(text);
    Some(match written == text {
        true => problem.carry(vec![Edit::new(node.span, retyped.trim_matches(['"', '\'']))], true),
        false => problem,
    })
}

fn retype(with: &str) -> String {
    match with.strip_suffix(' ') {
        Some(mark) => format!("retype it as `{mark}`, with a space after it"),
        None if matches!(with, "\"" | "'") => {
            "remove the quotes, which names do not need, or retype them as `\"`".to_owned()
        }
        None => format!("retype it as `{with}`"),
    }
}

fn look_alike_mark(letter: char, help: String, span: Span) -> Diagnostic {
    let (name, mark) = confusable::mark(letter).unwrap_or(("another character", ""));
    let message = format!("`{letter}` (U+{:04X}) is {name}, not `{mark}`", u32::from(letter));
    RULE.at(message, span, format!("not `{mark}`")).help(help).about(letter)
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
            error: [SCL0127] `–` (U+2013) is an en dash, not `-`
             --> topology.yaml:2:3
              |
            2 |   – name: sensor
              |   ^ not `-`
              |
              = help: retype it as `-`"#]],
        );
    }
}
