//! One gate becomes several of the same kind, each for some of its connections.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Edit};
use std::collections::HashSet;

/// Maximum number of gates that a proposal makes of one, and maximum size of their entries in bytes.
const MOST: usize = 8;
const LONGEST: usize = 4096;

/// One of the new gates.
pub(super) struct Part {
    pub(super) name: String,
    /// The connections that it takes over.
    pub(super) links: Vec<usize>,
}

/// Suggests the new gates and their connections, or says so in words if the gate shares its line with others or a name
/// is taken.
pub(super) fn suggest(draft: &Draft<'_>, found: Diagnostic, gate: usize, parts: &[Part], help: String) -> Diagnostic {
    match split(draft, gate, parts) {
        Some(edits) => found.suggest(help, edits),
        None => found.help(help),
    }
}

fn split(draft: &Draft<'_>, gate: usize, parts: &[Part]) -> Option<Vec<Edit>> {
    let (model, owner) = (draft.gates[gate].model, draft.component_name(gate));
    let is_free = |name: &str| draft.gate(owner, name).is_none_or(|other| other == gate);
    let names: HashSet<&str> = parts.iter().map(|part| part.name.as_str()).collect();
    if names.len() < parts.len() || parts.len() > MOST || !names.into_iter().all(is_free) {
        return None;
    }
    // The changes get the line breaks of the file when they are applied.
    let file = draft.sources.file(model.span.file);
    let before = file.text().get(..model.span.start as usize)?;
    let indent = before.get(file.line_range(before.len()).start..)?.strip_suffix("- ")?;
    let rest = file.snippet(model.span).get((model.name.span.end - model.span.start) as usize..)?;
    if !indent.trim().is_empty() || model.name.span.start != model.span.start || rest.len() > LONGEST {
        return None;
    }
    let rest = rest.replace('\r', "");
    let entries: Vec<String> =
        parts.iter().map(|part| format!("{}{rest}", draft.sources.quoted_as(model.name.span, &part.name))).collect();
    let mut edits = vec![Edit::new(model.span, entries.join(&format!("\n{indent}- ")))];
    for part in parts {
        let ends = part.links.iter().map(|&link| draft.end_span(link, gate));
        let path = format!("{owner}.{}", part.name);
        edits.extend(ends.map(|end| Edit::new(end, draft.sources.quoted_as(end, &path))));
    }
    Some(edits)
}
