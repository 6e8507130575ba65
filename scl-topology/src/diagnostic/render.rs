//! A diagnostic as text for people, in the style of rustc.

use super::{Diagnostic, Label, Severity};
use crate::source::{FileId, SourceFile, Sources};
use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Renderer, Snippet};
use std::ops::Range;

/// The whole text of a diagnostic, without a line break at its end:
///
/// ```text
/// error: [SCL0103] missing space after `:`
///  --> topology.yaml:2:9
///   |
/// 2 |   - name:sensor
///   |         ^ YAML reads `name:sensor` as one word
///   |
///   = help: write `name: sensor`
/// ```
///
/// Lines and columns count from 1, columns in characters; a tab is shown as 4 columns. Characters that would change
/// the terminal are shown as escapes.
pub fn render(diagnostic: &Diagnostic, sources: &Sources) -> String {
    render_with(&Renderer::plain(), diagnostic, sources)
}

/// As [`render`], with colours for a terminal.
pub fn render_styled(diagnostic: &Diagnostic, sources: &Sources) -> String {
    render_with(&Renderer::styled(), diagnostic, sources)
}

/// As [`render`], without the leading `error: ` or `warning: `, which rustc prints itself.
pub fn render_headless(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let text = render(diagnostic, sources);
    match text.find('[') {
        Some(code) => text[code..].to_owned(),
        None => text,
    }
}

fn render_with(renderer: &Renderer, diagnostic: &Diagnostic, sources: &Sources) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning | Severity::Lint => Level::WARNING,
    };
    let excerpts = excerpts(diagnostic, sources);
    let title = format!("[{}] {}", diagnostic.code(), one_line(&diagnostic.message));
    let mut elements: Vec<Element<'_>> = excerpts.iter().map(|excerpt| excerpt.snippet().into()).collect();
    elements.extend(diagnostic.helps.iter().map(|help| Level::HELP.message(lines(help)).into()));
    elements.extend(diagnostic.all_notes().map(|note| Level::NOTE.message(lines(&note)).into()));
    let group: Group<'_> = level.primary_title(title).elements(elements);
    let text = renderer.render(&[group]);
    // The renderer fills the gutter of lines without text with spaces.
    text.lines().map(str::trim_end).collect::<Vec<_>>().join("\n")
}

/// The lines of one file that a diagnostic points into.
struct Excerpt<'s> {
    path: &'s str,
    first_line: usize,
    text: String,
    marks: Vec<(Range<usize>, bool, String)>,
}

impl Excerpt<'_> {
    fn snippet(&self) -> Snippet<'_, Annotation<'_>> {
        let annotations = self.marks.iter().map(|(range, is_primary, text)| {
            let kind = if *is_primary { AnnotationKind::Primary } else { AnnotationKind::Context };
            let label = (!text.is_empty()).then_some(text.as_str());
            kind.span(range.clone()).label(label)
        });
        Snippet::source(self.text.as_str()).line_start(self.first_line).path(self.path).annotations(annotations)
    }
}

/// One excerpt a file, that of the primary label first.
fn excerpts<'s>(diagnostic: &Diagnostic, sources: &'s Sources) -> Vec<Excerpt<'s>> {
    let primary = diagnostic.primary.iter().map(|label| (label, true));
    let labels: Vec<_> = primary.chain(diagnostic.secondary.iter().map(|label| (label, false))).collect();
    let mut files: Vec<FileId> = Vec::new();
    for (label, _) in &labels {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    files.into_iter().map(|file| excerpt(sources.file(file), file, &labels)).collect()
}

fn excerpt<'s>(source: &'s SourceFile, file: FileId, labels: &[(&Label, bool)]) -> Excerpt<'s> {
    let marks: Vec<_> = labels
        .iter()
        .filter(|(label, _)| label.span.file == file)
        .map(|(label, is_primary)| (first_line_of(label, source), *is_primary, one_line(&label.text)))
        .collect();
    let start = marks.iter().map(|(range, ..)| source.line_range(range.start as u32).start).min().unwrap_or(0);
    let end = marks.iter().map(|(range, ..)| source.line_range(range.end as u32).end).max().unwrap_or(start);
    let written = source.text().get(start..end).unwrap_or("");
    let moved = |at: usize| at - start - written.get(..at - start).map_or(0, |before| before.matches("\r\n").count());
    let marks = marks.into_iter().map(|(range, primary, text)| (moved(range.start)..moved(range.end), primary, text));
    Excerpt {
        path: source.path(),
        first_line: source.line_column(start as u32).line as usize,
        marks: marks.collect(),
        text: written.replace("\r\n", "\n"),
    }
}

/// The part of a label in its first line: a frame around many lines would hide what it is about.
fn first_line_of(label: &Label, source: &SourceFile) -> Range<usize> {
    let text = source.text();
    let mut start = (label.span.start as usize).min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let line = source.line_range(start as u32);
    let start = start.min(line.end);
    let mut end = (label.span.end as usize).clamp(start, line.end);
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}

/// Text of one line in which nothing moves the cursor.
fn one_line(text: &str) -> String {
    escape(text, |_| false)
}

/// Text of several lines.
fn lines(text: &str) -> String {
    escape(text, |character| character == '\n')
}

fn escape(text: &str, keep: impl Fn(char) -> bool) -> String {
    let mut out = String::with_capacity(text.len());
    for character in text.chars() {
        match character.is_control() && !keep(character) || is_bidirectional(character) {
            true => out.extend(character.escape_default()),
            false => out.push(character),
        }
    }
    out
}

fn is_bidirectional(character: char) -> bool {
    matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests;
