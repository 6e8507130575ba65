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
    let comment = |link: usize| {
        let place = draft.links[link].model.span;
        let file = draft.sources.file(place.file);
        let line = file.line_range(place.start as usize);
        let head = file.text().get(line.start..place.start as usize)?.strip_suffix("- ")?;
        let tail = file.text().get(place.end as usize..line.end)?.trim_start();
        let dash = Span { start: place.start - 2, end: place.start - 2, ..place };
        let is_alone = head.trim().is_empty() && (tail.is_empty() || tail.starts_with('#'));
        is_alone.then(|| Edit::new(dash, "# "))
    };
    links.into_iter().map(comment).collect()
}
