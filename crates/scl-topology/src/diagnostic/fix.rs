//! Corrections as data, for `scl check --fix` and for editors.

use super::Diagnostic;
use crate::source::{SourceFile, Span};

/// One replacement of text that solves a problem, or a part of it.
///
/// The sure fixes of a diagnostic belong together and are applied together. Unsure ones are alternatives: editors offer
/// them, and no tool applies them by itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fix {
    /// What is replaced; an empty span inserts.
    pub span: Span,
    /// The new text; empty to remove the old one. Line breaks are `\n`, whatever the file has.
    pub replacement: String,
    /// Whether this is certainly what was meant.
    pub sure: bool,
}

impl Diagnostic {
    /// Adds a replacement that is certainly what was meant. `scl check --fix` applies it.
    pub fn fix(self, span: Span, replacement: impl Into<String>) -> Self {
        self.with_fix(span, replacement, true)
    }

    /// Adds a replacement that may have been meant. Editors offer it.
    pub fn maybe_fix(self, span: Span, replacement: impl Into<String>) -> Self {
        self.with_fix(span, replacement, false)
    }

    /// Adds replacements of one place: a single one is sure, several are alternatives.
    pub fn fix_if_single<S: AsRef<str>>(self, span: Span, replacements: &[S]) -> Self {
        let sure = replacements.len() == 1;
        replacements.iter().fold(self, |found, replacement| found.with_fix(span, replacement.as_ref(), sure))
    }

    /// As [`fix_if_single`](Self::fix_if_single), for a word at the primary place, which may be in quotes. Adds nothing
    /// if the word is written in another way, for example with escapes.
    pub fn fix_word<S: AsRef<str>>(self, word: &str, replacements: &[S]) -> Self {
        let Some(span) = self.primary.as_ref().map(|label| label.span) else { return self };
        let length = (span.end - span.start) as usize;
        match length.checked_sub(word.len()) {
            Some(0) => self.fix_if_single(span, replacements),
            Some(2) => self.fix_if_single(Span { start: span.start + 1, end: span.end - 1, ..span }, replacements),
            _ => self,
        }
    }

    /// Adds the removal of an item or an entry, if it shares its line with nothing else.
    pub(crate) fn fix_by_removal(self, source: &SourceFile, span: Span) -> Self {
        removal(source, span).into_iter().fold(self, |found, removed| found.fix(removed, ""))
    }

    fn with_fix(mut self, span: Span, replacement: impl Into<String>, sure: bool) -> Self {
        self.fixes.push(Fix { span, replacement: replacement.into(), sure });
        self
    }
}

/// Returns what to remove so that an item or an entry disappears with its comma, or with its line. `None` if it shares
/// its line with something else.
fn removal(source: &SourceFile, span: Span) -> Option<Span> {
    let text = source.text();
    let (before, after) = (text.get(..span.start as usize)?, text.get(span.end as usize..)?);
    let line = source.line_range(span.start as usize);
    let head = text.get(line.start..span.start as usize)?.trim_start();
    let rest = after.split('\n').next().unwrap_or(after);
    if (head.is_empty() || head == "- ") && rest.trim_end().is_empty() {
        let end = span.end as usize + rest.len();
        return Some(match end == text.len() {
            // The last line has no line break of its own, so remove the one before it.
            true => Span {
                start: before[..line.start].trim_end_matches(['\r', '\n']).len() as u32,
                end: end as u32,
                ..span
            },
            false => Span { start: line.start as u32, end: end as u32 + 1, ..span },
        });
    }
    if before.trim_end().ends_with(',') {
        return Some(Span { start: before.trim_end().len() as u32 - 1, ..span });
    }
    let spaces = after.len() - after.trim_start().len();
    let behind = after.trim_start().strip_prefix(',')?;
    let end = span.end as usize + spaces + 1 + (behind.len() - behind.trim_start_matches(' ').len());
    Some(Span { end: end as u32, ..span })
}

#[cfg(test)]
mod tests {
    use super::removal;
    use crate::source::{Sources, Span};

    #[test]
    fn an_item_goes_with_its_comma_or_its_line() {
        for (text, item, left) in [
            ("- a\n- [x]\n- b\n", "[x]", "- a\n- b\n"),
            ("- a\r\n- [x]\r\n- b\r\n", "[x]", "- a\r\n- b\r\n"),
            ("- a\n- [x]", "[x]", "- a"),
            ("- a\r\n- [x]", "[x]", "- a"),
            ("[a, x, b]", "x", "[a, b]"),
            ("[a, x]", "x", "[a]"),
            ("[x, a]", "x", "[a]"),
            ("[\n  x,\n  a\n]", "x", "[\n  \n  a\n]"),
            ("[x]", "x", "-"),
            ("- x # why", "x", "-"),
        ] {
            let mut sources = Sources::new();
            let file = sources.add("t.yaml", text);
            let start = text.find(item).unwrap();
            let span = Span { file, start: start as u32, end: (start + item.len()) as u32 };
            let found = removal(sources.file(file), span);
            let without = |span: Span| format!("{}{}", &text[..span.start as usize], &text[span.end as usize..]);
            assert_eq!(found.map_or("-".to_owned(), without), left, "{text:?}");
        }
    }
}
