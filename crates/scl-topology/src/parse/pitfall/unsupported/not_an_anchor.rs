//! `&` and `*` that were not meant as YAML's anchor and alias.

use super::ANCHOR;
use crate::diagnostic::{Diagnostic, Edit};
use crate::parse::pitfall::needs_quotes;
use crate::source::{SourceFile, Span};
use crate::yaml::Anchor;

/// `[&adc.samples, filter.samples]`: the name of a gate behind a mark with which other languages refer to something.
pub(super) fn reference(anchor: &Anchor, source: &SourceFile) -> Option<Diagnostic> {
    let start = single(anchor)?;
    let written = source.snippet(start);
    let name = written.get(1..).filter(|name| name.contains('.'))?;
    let rest = source.text().get(start.end as usize..)?.trim_start_matches(' ');
    if !rest.is_empty() && !rest.starts_with([',', ']', '\r', '\n', '#']) {
        return None;
    }
    let mark = &written[..1];
    let problem = ANCHOR.at(format!("`{mark}` before a name is not supported in a topology"), start, "");
    let removed = Edit::new(Span { end: start.start + 1, ..start }, "");
    Some(problem.suggest(format!("write `{name}`, without `{mark}`"), [removed]))
}

/// `doc: *bold* words`, where `*` or `&` is part of a text.
pub(super) fn text(anchor: &Anchor, source: &SourceFile) -> Option<Diagnostic> {
    needs_quotes::at_start(single(anchor)?, source)
}

/// The only place of an anchor or of an alias.
fn single(anchor: &Anchor) -> Option<Span> {
    match (anchor.definition, anchor.aliases.as_slice()) {
        (Some(definition), []) => Some(definition),
        (None, [alias]) => Some(*alias),
        _ => None,
    }
}
