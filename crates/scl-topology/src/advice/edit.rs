//! Applies changes to a text.

use crate::diagnostic::Edit;

/// Returns the text with the changes applied; `None` if two of them overlap, or one lies outside of the text. Line
/// breaks in the changes become those of the text.
pub fn apply(text: &str, edits: &[&Edit]) -> Option<String> {
    let line_break = if is_crlf(text) { "\r\n" } else { "\n" };
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    for edit in sorted(edits) {
        let (start, end) = (edit.span.start as usize, edit.span.end as usize);
        out.push_str(text.get(at..start)?);
        text.get(start..end)?;
        out.push_str(&edit.replacement.replace('\n', line_break));
        at = end;
    }
    out.push_str(text.get(at..)?);
    Some(out)
}

/// The changes in the order of their places.
pub(super) fn sorted<'e>(edits: &[&'e Edit]) -> Vec<&'e Edit> {
    let mut sorted = edits.to_vec();
    sorted.sort_by_key(|edit| (edit.span.start, edit.span.end));
    sorted
}

/// Whether most lines of a text end with a carriage return.
pub(super) fn is_crlf(text: &str) -> bool {
    2 * text.matches("\r\n").count() > text.matches('\n').count()
}
