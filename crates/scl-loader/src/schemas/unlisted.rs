//! Schema files that a topology does not name, although they may declare types of its gates.

use super::folders::Folders;
use super::outline::outline;
use scl_topology::check::{SchemaMessages, UnlistedSchema};
use scl_topology::model::Model;
use std::collections::HashSet;

/// Looks for the types that are not among the `messages` in the schema files beside those that were compiled.
pub(super) fn unlisted(model: &Model, messages: &[SchemaMessages], folders: &Folders) -> Vec<UnlistedSchema> {
    let mut unknown: HashSet<&str> = payloads(model).filter(|name| name.contains('.')).collect();
    messages.iter().flat_map(|schema| &schema.names).for_each(|name| {
        unknown.remove(name.as_str());
    });
    if unknown.is_empty() {
        return Vec::new();
    }
    let files = folders.schema_files().into_iter();
    let declared = files.filter_map(|path| {
        let outline = outline(&folders.read(&path)?);
        let names: Vec<String> = outline.full_names().filter(|name| unknown.contains(name.as_str())).collect();
        let path = folders.relative(&path).to_str()?.to_owned();
        (!names.is_empty()).then_some(UnlistedSchema { path, names })
    });
    declared.collect()
}

/// The types of all gates, as written.
pub(super) fn payloads(model: &Model) -> impl Iterator<Item = &str> {
    let gates = model.components.iter().flat_map(|component| &component.gates);
    gates.filter_map(|gate| gate.payload.as_ref()).flat_map(|types| types.value.split("->").map(str::trim))
}
