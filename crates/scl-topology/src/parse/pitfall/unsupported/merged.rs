//! The lists of a second document, moved to the ends of those in the first.

use crate::diagnostic::Edit;
use crate::source::SourceFile;
use scl_text::list::all_of;
use std::ops::Range;

/// Maximum number of sections that are moved.
const MOST: usize = 8;

/// A key at the start of a line, up to the next one.
struct Section<'t> {
    key: &'t str,
    whole: Range<usize>,
    /// What stands below the line of the key.
    body: Range<usize>,
    /// The column of the first item.
    column: usize,
}

/// The keys that both parts of a text have, around the `marker` between them, and the changes that move what stands
/// below them. `None` if no key is in both, or one is written in another way.
pub(super) fn sections(marker: &Range<usize>, source: &SourceFile) -> Option<(String, Vec<Edit>)> {
    let text = source.text();
    let above = sections_of(0..marker.start, text);
    let below = sections_of(marker.end..text.len(), text);
    let mut keys = Vec::new();
    let mut edits = Vec::new();
    for section in &below {
        let Some(first) = above.iter().find(|first| first.key == section.key) else { continue };
        if first.column == 0 || first.column != section.column || keys.len() == MOST {
            return None;
        }
        let end = first.body.start + text[first.body.clone()].trim_end().len();
        let moved = text[section.body.clone()].trim_end();
        edits.push(Edit::new(source.span(end..end), format!("\n{}", moved.replace("\r\n", "\n"))));
        edits.push(Edit::new(source.span(section.whole.clone()), ""));
        keys.push(section.key);
    }
    (!keys.is_empty()).then(|| (all_of(&keys), edits))
}

/// The sections of a part of a text. Comments above the first key belong to none.
fn sections_of(part: Range<usize>, text: &str) -> Vec<Section<'_>> {
    let mut sections: Vec<Section<'_>> = Vec::new();
    let mut at = part.start;
    for line in text[part].split_inclusive('\n') {
        let end = at + line.len();
        match line.split_once(':').filter(|_| line.starts_with(|first: char| first.is_ascii_alphabetic())) {
            Some((key, _)) => sections.push(Section { key, whole: at..end, body: end..end, column: 0 }),
            None => {
                if let Some(section) = sections.last_mut() {
                    let indent = line.len() - line.trim_start_matches(' ').len();
                    section.column =
                        if section.column == 0 && !line.trim().is_empty() { indent } else { section.column };
                    (section.whole.end, section.body.end) = (end, end);
                }
            }
        }
        at = end;
    }
    sections
}
