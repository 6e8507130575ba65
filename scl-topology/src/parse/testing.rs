//! What the tests of the rules share.

use super::parse;
use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;
use crate::source::Sources;

/// Parses a text under the name `topology.yaml`; the problems are sorted by position.
pub(super) fn parse_text(text: &str) -> (Model, Vec<Diagnostic>, Sources) {
    let mut sources = Sources::new();
    let file = sources.add("topology.yaml", text);
    let mut problems = Diagnostics::new();
    let model = parse(&sources, file, &mut problems);
    (model, problems.into_sorted(), sources)
}
