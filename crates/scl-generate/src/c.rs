//! `--for c`: a header and a source with typed functions per component and gate, over `scl.h`.
//!
//! A gate whose codec is protobuf and whose message is in `schemas:` has functions for the message structs of
//! protobuf-c; any other gate has functions for bytes.

mod component_functions;
mod content;
mod function;
mod gate;
mod header;
mod helpers;
mod literal;
mod protobuf_c;
mod recursion;
mod source;
mod wait;

use crate::clash::{Declaration, Origin};
use crate::output::File;
use crate::system::{Component, System};
use content::Content;
use std::collections::BTreeMap;

/// The scope of everything but members of structs.
const C: &str = "C";

/// The names that the header declares, and those of the messages that it uses.
pub(crate) fn declarations(system: &System) -> Vec<Declaration> {
    let mut found = Vec::new();
    let mut declare = |scope: &str, name: String, origin: Origin| {
        found.push(Declaration { scope: scope.to_owned(), name, origin });
    };
    for message in messages(system) {
        protobuf_c::declared(&message.dotted).into_iter().for_each(|name| declare(C, name, Origin::message(&message)));
    }
    for component in system.components_and_counterparts() {
        let prefix = prefix(system, component);
        declare(C, prefix.clone(), Origin::component(component));
        for call in ["open", "test", "ready", "close", "wait"] {
            let is_declared = match call {
                "open" => component.counterpart_of.is_none(),
                "test" => component.counterpart.is_some(),
                _ => true,
            };
            if is_declared {
                declare(C, format!("{prefix}_{call}"), Origin::component(component));
            }
        }
        for gate in &component.gates {
            let origin = Origin::gate(component, gate);
            gate::declared(&prefix, gate).into_iter().for_each(|name| declare(C, name, origin.clone()));
            declare(&format!("the C struct `{prefix}`"), gate::member(gate), origin);
        }
        for gate in wait::gates(component) {
            declare(C, wait::constant(&prefix, gate), Origin::gate(component, gate));
        }
    }
    found
}

/// `<system>_scl.h` and `<system>_scl.c`.
pub(crate) fn files(system: &System) -> Vec<File> {
    let name = system.snake_name();
    vec![
        File { name: format!("{name}_scl.h"), text: header::text(system) },
        File { name: format!("{name}_scl.c"), text: source::text(system) },
    ]
}

/// What the names of a component begin with: `rover_sensor`.
fn prefix(system: &System, component: &Component) -> String {
    format!("{}_{}", system.snake_name(), component.snake_name)
}

/// The messages with structs, each once.
fn messages(system: &System) -> Vec<crate::MessageUse> {
    let used = system.gates().flat_map(|gate| gate.types.iter().filter(|used| Content::of(gate, used).is_struct()));
    let by_name: BTreeMap<&str, &crate::MessageUse> = used.map(|used| (used.dotted.as_str(), used)).collect();
    by_name.into_values().cloned().collect()
}
