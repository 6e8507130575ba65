//! SCL0121: a syntax error that no other rule explains.

use super::{dash, missing_mark};
use crate::diagnostic::{Diagnostic, Edit, Rule, Severity};
use crate::parse::dialect::Dialect;
use crate::source::SourceFile;
use crate::yaml::SyntaxError;
use std::ops::Range;

/// SCL0121.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0121",
    severity: Severity::Error,
    title: "text that is not YAML",
    explanation: "The text is not valid YAML, and no single change near this place makes it valid, so there may be \
                  several mistakes. The message shows where the parser gave up; the first mistake is there or shortly \
                  before.",
    example: " components:
   - name: sensor
-sensor = reads = the bus
-  - name: camera
-camera = optional = yes
+    gates: []
",
};

pub(in crate::parse) fn diagnose(error: &SyntaxError, source: &SourceFile) -> Diagnostic {
    let text = source.text();
    let mut at = error.at;
    while at > 0 && !text.is_char_boundary(at) {
        at -= 1;
    }
    let end = at + text[at..].chars().next().filter(|c| !c.is_control()).map_or(0, char::len_utf8);
    let words = error.words.rsplit(", ").next().unwrap_or(&error.words);
    RULE.at(format!("this is not valid YAML: {words}"), source.span(at..end), "the parser stops here")
        .help("the mistake is here or shortly before")
}

/// A section or key without its colon, in the line of the error or the one before.
pub(in crate::parse) fn missing_colon(
    error: &SyntaxError,
    source: &SourceFile,
    dialect: &Dialect,
) -> Option<Diagnostic> {
    let text = source.text();
    here_and_above(error, source).find_map(|line| {
        let content = text[line.clone()].trim_start_matches([' ', '-']);
        let word = content.split([' ', '#']).next().filter(|word| (dialect.is_key)(word))?;
        let start = line.end - content.len();
        let end = start + word.len();
        let colon = vec![Edit::new(source.span(end..end), ":")];
        Some(missing_mark::colon_after(&(start..end), text, source).carry(colon, false))
    })
}

/// The line of the error and the one above it.
fn here_and_above(error: &SyntaxError, source: &SourceFile) -> impl Iterator<Item = Range<usize>> {
    let here = source.line_range(error.at);
    let above = here.start.checked_sub(1).map(|at| source.line_range(at));
    std::iter::once(here).chain(above)
}

/// `-sensor` or `-- sensor` where `- sensor` is meant.
pub(in crate::parse) fn missing_dash_space(error: &SyntaxError, source: &SourceFile) -> Option<Diagnostic> {
    let text = source.text();
    here_and_above(error, source).find_map(|line| {
        let word = text[line.clone()].trim_start_matches(' ');
        let rest = word.trim_start_matches('-');
        let dashes = word.len() - rest.len();
        let starts_word = rest.trim_start().starts_with(|c: char| c.is_alphabetic() || c == '[');
        let at = line.end - word.len()..line.end - word.len() + dashes;
        match dashes {
            1 if starts_word && !rest.starts_with(' ') => {
                let space = vec![Edit::new(source.span(at.end..at.end), " ")];
                Some(dash::without_space(&at, text, source).carry(space, false))
            }
            2 if starts_word => {
                let dash = if rest.starts_with(' ') { "-" } else { "- " };
                let edit = vec![Edit::new(source.span(at.clone()), dash)];
                Some(dash::doubled(&at, text, source).carry(edit, false))
            }
            _ => None,
        }
    })
}
