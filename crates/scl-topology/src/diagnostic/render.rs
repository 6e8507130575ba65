//! A diagnostic as text for people, in the style of rustc.

mod excerpt;

use super::{Diagnostic, Severity};
use crate::source::{FileId, LineColumn, Sources};
use crate::work;
use annotate_snippets::{Annotation, AnnotationKind, Element, Group, Level, Origin, Padding, Renderer, Snippet};
use excerpt::{Chunk, Excerpt};
use std::borrow::Cow;

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
    let mut elements = elements(&excerpts);
    elements.extend(diagnostic.shown_helps().map(|help| Level::HELP.message(lines(&help.text())).into()));
    elements.extend(diagnostic.all_notes().map(|note| Level::NOTE.message(lines(&note)).into()));
    let group: Group<'_> = level.primary_title(title).elements(elements);
    let text = renderer.render(&[group]);
    joined(&text, excerpts.iter().map(|excerpt| excerpt.chunks.len()))
}

/// One excerpt for each file, starting with the file of the primary label.
fn excerpts<'s>(diagnostic: &Diagnostic, sources: &'s Sources) -> Vec<Excerpt<'s>> {
    let primary = diagnostic.primary.iter().map(|label| (label, true));
    let labels: Vec<_> = primary.chain(diagnostic.secondary.iter().map(|label| (label, false))).collect();
    let mut files: Vec<FileId> = Vec::new();
    for (label, _) in &labels {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    files.into_iter().map(|file| Excerpt::new(sources.file(file), file, &labels)).collect()
}

/// Each file with its path and position, followed by its chunks as snippets without a path: only then can the position
/// refer to the whole file, although the snippets are cut.
fn elements<'e>(excerpts: &'e [Excerpt<'_>]) -> Vec<Element<'e>> {
    let mut elements: Vec<Element<'e>> = Vec::new();
    for (number, excerpt) in excerpts.iter().enumerate() {
        if number > 0 {
            elements.push(Padding.into());
        }
        let LineColumn { line, column } = excerpt.at;
        elements.push(Origin::path(excerpt.path).line(line as usize).char_column(column as usize).into());
        elements.extend(excerpt.chunks.iter().map(|chunk| snippet(chunk).into()));
    }
    elements
}

fn snippet(chunk: &Chunk) -> Snippet<'_, Annotation<'_>> {
    work::add(chunk.text.len());
    let annotations = chunk.marks.iter().map(|mark| {
        let kind = if mark.is_primary { AnnotationKind::Primary } else { AnnotationKind::Context };
        kind.span(mark.range.clone()).label((!mark.text.is_empty()).then_some(mark.text.as_str()))
    });
    Snippet::source(chunk.text.as_str()).line_start(chunk.first_line as usize).annotations(annotations)
}

/// Joins the chunks of a file to one excerpt. The renderer writes `|` and `:::` before each snippet without a path.
/// After the path only `|` is kept; between two chunks, `...` stands for the lines that are not shown.
fn joined(text: &str, chunks: impl Iterator<Item = usize>) -> String {
    let mut is_first = chunks.flat_map(|count| (0..count).map(|chunk| chunk == 0));
    let mut out: Vec<Cow<'_, str>> = Vec::new();
    for line in text.lines() {
        // The renderer fills the gutter of lines without text with spaces.
        let line = line.trim_end();
        if !is_gap(line) {
            out.push(line.into());
        } else if is_first.next() == Some(false) {
            out.pop();
            out.push(line.trim_start().replacen(":::", "...", 1).into());
        }
    }
    out.join("\n")
}

/// Whether a line is `:::` and nothing else but spaces and colours.
fn is_gap(line: &str) -> bool {
    line.split_once(":::").is_some_and(|(before, after)| is_blank(before) && is_blank(after))
}

fn is_blank(text: &str) -> bool {
    text.split('\u{1b}').enumerate().all(|(number, part)| {
        let text = if number == 0 { part } else { part.split_once('m').map_or("", |(_, rest)| rest) };
        text.trim().is_empty()
    })
}

/// Escapes what would move the cursor or reorder text, including line breaks.
fn one_line(text: &str) -> String {
    escape(text, |_| false)
}

/// As [`one_line`], but keeps line breaks.
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
