//! Components in comments: their connections may have been forgotten.

use super::draft::Draft;
use super::end::End;
use crate::diagnostic::Edit;
use crate::source::Span;
use std::collections::HashMap;

/// The names of components in comments, `# - name: sensor`, with their places.
pub(super) fn names<'m>(draft: &Draft<'m>) -> HashMap<&'m str, Span> {
    let Some(place) = draft.model.connections_key else { return HashMap::new() };
    let file = draft.sources.file(place.file);
    let mut names = HashMap::new();
    let mut start = 0;
    for line in file.text().split_inclusive('\n') {
        if let Some(name) = name_in(line) {
            let at = start + line.find(name).unwrap_or_default();
            names.entry(name).or_insert_with(|| file.span(at..at + name.len()));
        }
        start += line.len();
    }
    names
}

/// The name in `# - name: sensor` or `# - {name: sensor, ...`.
fn name_in(line: &str) -> Option<&str> {
    let item = line.trim_start().strip_prefix('#')?.trim_start_matches(['#', ' ']).strip_prefix('-')?;
    let name = item.trim_start().trim_start_matches('{').trim_start().strip_prefix("name:")?;
    let is_letter = |letter: char| letter.is_alphanumeric() || matches!(letter, '_' | '-');
    name.trim_start_matches([' ', '"', '\'']).split(|letter| !is_letter(letter)).next().filter(|name| !name.is_empty())
}

/// The changes that make comments of the connections with some ends, if each has a line of its own.
pub(super) fn with_connections(draft: &Draft<'_>, ends: &[End]) -> Option<Vec<Edit>> {
    let mut links: Vec<usize> = ends.iter().map(|[link, _]| *link).collect();
    links.dedup();
    links.into_iter().map(|link| as_comment(draft, draft.links[link].model.span)).collect()
}

/// The change that makes a comment of a list item, if it has a line of its own.
pub(super) fn as_comment(draft: &Draft<'_>, item: Span) -> Option<Edit> {
    let file = draft.sources.file(item.file);
    let line = file.line_range(item.start as usize);
    let head = file.text().get(line.start..item.start as usize)?.strip_suffix("- ")?;
    let tail = file.text().get(item.end as usize..line.end)?.trim_start();
    let dash = Span { start: item.start - 2, end: item.start - 2, ..item };
    let is_alone = head.trim().is_empty() && (tail.is_empty() || tail.starts_with('#'));
    is_alone.then(|| Edit::new(dash, "# "))
}
