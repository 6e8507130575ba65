//! What `#[scl::main]` needs to know about a topology.

use super::context::Context;
use super::problems::unknown_type_name;
use crate::known_components::{KnownComponent, KnownTopology};
use scl_topology::rust_name::component_type;

/// The components of the file, even if it has errors.
pub(super) fn known_topology(context: &Context<'_>) -> KnownTopology {
    let model = &context.loaded.model;
    let mut instances = vec![Vec::new(); model.kinds.len()];
    for component in &model.components {
        if let Some(kind) = component.of {
            instances[kind].push(component_type(&component.name.value));
        }
    }
    // The kinds come first.
    let instances = instances.into_iter().chain(std::iter::repeat(Vec::new()));
    let components = model.owners().zip(instances).map(|(owner, instances)| {
        let name = owner.name.value.clone();
        KnownComponent { rust_name: component_type(&name), included: context.includes(&name), name, instances }
    });
    KnownTopology {
        path: context.path.clone(),
        components: components.collect(),
        broken: context.loaded.topology.is_none(),
        unknown_type: unknown_type_name(context).to_string(),
    }
}
