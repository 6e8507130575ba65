//! What `#[scl::main]` needs to know about a topology.

use super::context::Context;
use super::problems::unknown_type_name;
use crate::known_components::{KnownComponent, KnownTopology};
use scl_topology::rust_name::component_type;

/// The components of the file, even if it has errors.
pub(super) fn known_topology(context: &Context<'_>) -> KnownTopology {
    let components = context.loaded.model.components.iter().map(|component| {
        let name = component.name.value.clone();
        KnownComponent { rust_name: component_type(&name), included: context.includes(&name), name }
    });
    KnownTopology {
        path: context.path.clone(),
        components: components.collect(),
        broken: context.loaded.topology.is_none(),
        unknown_type: unknown_type_name(context).to_string(),
    }
}
