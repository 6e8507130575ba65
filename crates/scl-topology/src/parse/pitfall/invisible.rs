//! SCL0117: a character that is invisible, or that only looks like a space.

use super::scan::{Scan, blank};
use crate::diagnostic::{Diagnostic, Diagnostics, Edit, Rule, Severity};
use crate::source::SourceFile;
use std::collections::BTreeMap;

/// SCL0117.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0117",
    severity: Severity::Error,
    title: "invisible or control character",
    explanation: "The file contains a character that is invisible, or that looks like a space but is not one. Such \
                  characters come from web pages and word processors; they make names differ that look the same. \
                  Remove the character, or replace it with an ordinary space.",
    example: " components:
-  - name:\u{a0}sensor
+  - name: sensor
+    gates: []
",
};

/// Reports each such character once, at its first place, and replaces all of them by spaces. Returns true if there are
/// any.
pub(super) fn check(source: &SourceFile, scan: &Scan, text: &mut String, problems: &mut Diagnostics) -> bool {
    let mut places: BTreeMap<char, Vec<usize>> = BTreeMap::new();
    for (at, character) in text.char_indices() {
        if is_bad(character, text, at, scan) {
            places.entry(character).or_default().push(at);
        }
    }
    if places.is_empty() {
        return false;
    }
    // The characters of UTF-16 leave a NUL behind each letter and each line break.
    if places.get(&'\0').is_some_and(|nulls| nulls.windows(2).any(|pair| pair[1] - pair[0] == 2)) {
        places.remove(&'\r');
    }
    for (character, places) in places {
        problems.push(diagnose(character, &places, source));
        blank(text, places.into_iter().map(|at| at..at + character.len_utf8()));
    }
    true
}

/// Whether a character is reported. Comments and quoted texts may hold spaces and joiners of all kinds, but nothing
/// that hides or reorders text.
fn is_bad(character: char, text: &str, at: usize, scan: &Scan) -> bool {
    match character {
        '\t' | '\n' => false,
        '\r' => !text[at + 1..].starts_with('\n'),
        '\0'..='\u{1f}' | '\u{7f}'..='\u{9f}' => true,
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        '\u{a0}'
        | '\u{ad}'
        | '\u{2000}'..='\u{200d}'
        | '\u{2028}'
        | '\u{2029}'
        | '\u{202f}'
        | '\u{205f}'
        | '\u{2060}'
        | '\u{3000}'
        | '\u{feff}' => !scan.is_free_text(at),
        _ => false,
    }
}

fn diagnose(character: char, places: &[usize], source: &SourceFile) -> Diagnostic {
    let first = places.first().copied().unwrap_or_default();
    let span = source.span(first..first + character.len_utf8());
    let (name, label, help) = describe(character);
    let kind = if character.is_control() { "control character" } else { "invisible character" };
    let name = if name.is_empty() { String::new() } else { format!(" ({name})") };
    let replacement = match help {
        REPLACE => " ",
        REMOVE => "",
        _ => "\n",
    };
    let edits = places.iter().map(|&at| Edit::new(source.span(at..at + character.len_utf8()), replacement));
    let problem = RULE
        .at(format!("{kind} U+{:04X}{name}", u32::from(character)), span, label)
        .propose(help, edits)
        .note(match character {
            '\0' => "such characters come from text in UTF-16; a topology file is UTF-8",
            _ => "such characters usually come from a web page or a word processor",
        })
        .note(
            "same check: U+FEFF inside the file, U+200B..U+200F, U+202A..U+202E (bidirectional control), U+0085, \
             U+2028, U+2029, and control characters below U+0020",
        );
    match places.len() {
        1 => problem,
        count => problem.note(format!("it occurs {count} times in this file")),
    }
}

const REPLACE: &str = "replace it with an ordinary space";
const REMOVE: &str = "remove it";

fn describe(character: char) -> (&'static str, &'static str, &'static str) {
    const SPACE: &str = "looks like a space, but YAML does not treat it as one";
    const BREAK: &str = "looks like a line break, but is read in different ways";
    match character {
        '\0' => ("null", "YAML does not allow it", REMOVE),
        '\r' => ("carriage return without a line feed", BREAK, "save the file with ordinary line ends"),
        '\u{85}' => ("next line", BREAK, "replace it with an ordinary line break"),
        '\u{2028}' => ("line separator", BREAK, "replace it with an ordinary line break"),
        '\u{2029}' => ("paragraph separator", BREAK, "replace it with an ordinary line break"),
        '\u{a0}' => ("no-break space", SPACE, REPLACE),
        '\u{202f}' => ("narrow no-break space", SPACE, REPLACE),
        '\u{3000}' => ("ideographic space", SPACE, REPLACE),
        '\u{2000}'..='\u{200a}' | '\u{205f}' => ("typographic space", SPACE, REPLACE),
        '\u{200b}' => ("zero width space", "not visible", REMOVE),
        '\u{200c}' | '\u{200d}' | '\u{2060}' => ("joiner", "not visible", REMOVE),
        '\u{ad}' => ("soft hyphen", "not visible", REMOVE),
        '\u{feff}' => ("byte order mark inside the file", "not visible", REMOVE),
        '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => {
            ("bidirectional control", "it changes the order in which the text is shown", REMOVE)
        }
        _ => ("", "YAML does not allow it", REMOVE),
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
            error: [SCL0117] invisible character U+00A0 (no-break space)
             --> topology.yaml:2:10
              |
            2 |   - name: sensor
              |          ^ looks like a space, but YAML does not treat it as one
              |
              = help: replace it with an ordinary space
              = note: such characters usually come from a web page or a word processor
              = note: same check: U+FEFF inside the file, U+200B..U+200F, U+202A..U+202E (bidirectional control), U+0085, U+2028, U+2029, and control characters below U+0020"#]],
        );
    }
}
