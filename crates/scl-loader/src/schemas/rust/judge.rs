//! Whether the Rust names of compiled schemas can be used.

use super::clash::find_clashes;
use super::hidden_crate::find_hidden_crates;
use crate::schemas::place::{Places, Texts};
use prost_types::FileDescriptorProto;
use scl_topology::diagnostic::Diagnostics;
use scl_topology::model::Model;

/// Reports names that clash or hide a crate; returns false if some clash.
pub(in crate::schemas) fn judge_names(
    compiled: &[FileDescriptorProto],
    model: &Model,
    texts: Texts<'_>,
    problems: &mut Diagnostics,
) -> bool {
    let (request, folders) = (texts.request, texts.folders);
    let mut places = Places::new(texts, compiled);
    let entry = |file: &str| model.schemas.get(folders.entry(file)).map(|schema| schema.span);
    problems.extend(find_hidden_crates(compiled, request, entry, &mut places));
    let clashes = find_clashes(compiled, model, &mut places);
    let names_fit = clashes.is_empty();
    problems.extend(clashes);
    names_fit
}
