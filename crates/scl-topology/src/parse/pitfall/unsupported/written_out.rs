//! The value of an anchor in the place of its aliases.

use crate::diagnostic::Edit;
use crate::source::{SourceFile, Span};
use crate::yaml::Anchor;

/// Maximum number of lines, and of aliases, that are written out.
const MOST: usize = 64;

/// Maximum length of a value that is written out.
const LONGEST: usize = 4096;

/// Removes an anchor, and writes its value in the place of each alias. `None` if the value is long.
pub(super) fn edits(anchor: &Anchor, source: &SourceFile) -> Option<Vec<Edit>> {
    let definition = anchor.definition.filter(|_| !anchor.aliases.is_empty() && anchor.aliases.len() <= MOST)?;
    let text = source.text();
    let start = definition.end as usize;
    let line = source.line_range(start);
    if line.len() > LONGEST {
        return None;
    }
    let rest = text[start..line.end].split(" #").next().unwrap_or("");
    let value = rest.trim();
    let mut edits = vec![without(definition, rest, source)];
    if !value.is_empty() {
        edits.extend(anchor.aliases.iter().map(|alias| Edit::new(*alias, value)));
        return Some(edits);
    }
    let block = block(source, definition)?;
    for alias in &anchor.aliases {
        let indent = column_of_key(source, *alias);
        let before = text[..alias.start as usize].trim_end_matches(' ').len();
        let lines = block.iter().map(|(deeper, line)| format!("\n{}{line}", " ".repeat(indent + deeper)));
        edits.push(Edit::new(source.span(before..alias.end as usize), lines.collect::<String>()));
    }
    Some(edits)
}

fn without(definition: Span, rest: &str, source: &SourceFile) -> Edit {
    let spaces = rest.len() - rest.trim_start_matches(' ').len();
    let start = match rest.trim().is_empty() {
        true => source.text()[..definition.start as usize].trim_end_matches(' ').len(),
        false => definition.start as usize,
    };
    Edit::new(source.span(start..definition.end as usize + spaces), "")
}

/// The column of the key in whose line something stands.
fn column_of_key(source: &SourceFile, at: Span) -> usize {
    let line = &source.text()[source.line_range(at.start as usize)];
    line.len() - line.trim_start_matches([' ', '-']).len()
}

/// The lines below an anchor that are its value, each with the number of spaces that it is deeper than the anchor's
/// key.
fn block(source: &SourceFile, definition: Span) -> Option<Vec<(usize, &str)>> {
    let column = column_of_key(source, definition);
    let end = source.line_range(definition.end as usize).end;
    let mut lines = Vec::new();
    for line in source.text()[end..].split_inclusive('\n').skip(1) {
        let content = line.trim();
        let indent = line.len() - line.trim_start_matches(' ').len();
        if content.is_empty() {
            continue;
        }
        if indent < column || indent == column && !content.starts_with('-') {
            break;
        }
        lines.push((indent - column, content));
        if lines.len() > MOST || line.len() > LONGEST / MOST {
            return None;
        }
    }
    (!lines.is_empty()).then_some(lines)
}
