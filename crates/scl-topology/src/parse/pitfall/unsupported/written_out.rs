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
    let block = if value.is_empty() { Some(block(source, definition)?) } else { None };
    for alias in &anchor.aliases {
        edits.push(match (merge(*alias, source), &block) {
            (Some(place), _) => Edit::new(place, keys(anchor, source)?.join(&separator(place, source))),
            (None, None) => Edit::new(*alias, value),
            (None, Some(block)) => {
                let indent = column_of_key(source, *alias);
                let before = text[..alias.start as usize].trim_end_matches(' ').len();
                let lines = block.iter().map(|(deeper, line)| format!("\n{}{line}", " ".repeat(indent + deeper)));
                Edit::new(source.span(before..alias.end as usize), lines.collect::<String>())
            }
        });
    }
    Some(edits)
}

/// The place of `<<: *name`, if the alias stands there.
pub(super) fn merge(alias: Span, source: &SourceFile) -> Option<Span> {
    let before = source.text().get(..alias.start as usize)?.trim_end_matches(' ').strip_suffix("<<:")?;
    Some(Span { start: before.len() as u32, ..alias })
}

/// The keys of an anchor's mapping with their values. `None` if one of them is not on one line.
pub(super) fn keys(anchor: &Anchor, source: &SourceFile) -> Option<Vec<String>> {
    let definition = anchor.definition?;
    let line = source.line_range(definition.end as usize);
    let rest = source.text().get(definition.end as usize..line.end).filter(|rest| rest.len() <= LONGEST)?;
    let value = rest.split(" #").next().unwrap_or("").trim();
    if let Some(inner) = value.strip_prefix('{').and_then(|value| value.strip_suffix('}')) {
        let is_plain = !inner.contains(['{', '[', '"', '\'']);
        return is_plain.then(|| inner.split(',').map(|entry| entry.trim().to_owned()).collect());
    }
    let block = block(source, definition).filter(|_| value.is_empty())?;
    let entry = |(deeper, line): &(usize, &str)| {
        let entry = line.split(" #").next().unwrap_or(line).trim_end();
        (*deeper == block[0].0 && entry.contains(": ")).then(|| entry.to_owned())
    };
    block.iter().map(entry).collect()
}

/// What stands between two keys of a mapping that has one here.
fn separator(key: Span, source: &SourceFile) -> String {
    let start = source.line_range(key.start as usize).start;
    let head = source.text().get(start..key.start as usize).unwrap_or("");
    match head.trim_start_matches([' ', '-']).is_empty() {
        true => format!("\n{}", " ".repeat(head.len())),
        false => ", ".to_owned(),
    }
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
