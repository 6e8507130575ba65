//! Moves an item of a list into another list, for proposals.

use super::shift;
use crate::diagnostic::Edit;
use crate::parse::with_dash;
use crate::source::{SourceFile, Span};

/// Cuts the lines of an item, and pastes them below another item, indented like it. `None` if one of them shares a line
/// with something else.
pub(super) fn below(item: Span, above: Span, source: &SourceFile) -> Option<Vec<Edit>> {
    let (from, to) = (dash_column(item, source)?, dash_column(above, source)?);
    let start = source.line_range(with_dash(item, source).start as usize).start;
    let end = source.line_range(item.end as usize).end;
    let lines = source.text().get(start..end)?.lines().map(|line| {
        let content = line.trim_start_matches(' ');
        let indent = (line.len() - content.len() + to).saturating_sub(from);
        if content.is_empty() { String::new() } else { format!("{}{content}", " ".repeat(indent)) }
    });
    let moved = lines.collect::<Vec<_>>().join("\n");
    let paste = source.line_range(above.end as usize).end;
    // The last item of a list inside of the other item is in its place already.
    if (start..=end).contains(&paste) {
        return Some(vec![Edit::new(source.span(start..end), moved)]);
    }
    let cut = end + usize::from(end < source.text().len());
    Some(vec![Edit::new(source.span(start..cut), ""), Edit::new(source.span(paste..paste), format!("\n{moved}"))])
}

/// The column of an item's dash, if nothing precedes it in its line.
fn dash_column(item: Span, source: &SourceFile) -> Option<usize> {
    let dash = with_dash(item, source);
    let is_first = shift::head(dash.start, source).chars().all(|letter| letter == ' ');
    (is_first && dash.start < item.start).then(|| source.column(dash.start))
}
