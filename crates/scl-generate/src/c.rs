//! `--for c`: a header and a source with typed functions per component and gate, over `scl.h`.
//!
//! A gate whose codec is protobuf and whose message is in `schemas:` has functions for the message structs of
//! protobuf-c; any other gate has functions for bytes.

mod comment;
mod component_functions;
mod content;
mod enumeration;
mod function;
mod gate;
mod header;
mod helpers;
mod literal;
mod parameters;
mod protobuf_c;
mod recursion;
mod source;
mod wait;

use crate::clash::{Declaration, Origin};
use crate::output::File;
use crate::system::{Component, System};
use component_functions::component_functions;
use content::Content;
use function::Function;
use std::collections::BTreeMap;

/// The scope of everything but members of structs.
const C: &str = "C";

/// The names that the header declares, and those of the messages that it uses.
pub(crate) fn declarations(system: &System) -> Vec<Declaration> {
    let mut found = Vec::new();
    let mut declare = |scope: &str, name, origin| found.push(Declaration::new(scope, name, origin));
    for message in messages(system) {
        protobuf_c::declared(&message.dotted).into_iter().for_each(|name| declare(C, name, Origin::message(&message)));
    }
    for component in system.components_and_counterparts() {
        let prefix = prefix(system, component);
        let functions = component_functions(system, component).into_iter().map(|function| function.name);
        for name in [prefix.clone()].into_iter().chain(functions).chain([format!("{prefix}_wait")]) {
            declare(C, name, Origin::component(component));
        }
        for gate in &component.gates {
            let origin = Origin::gate(component, gate);
            gate::declared(system, &prefix, gate).into_iter().for_each(|name| declare(C, name, origin.clone()));
            declare(&format!("the C struct `{prefix}`"), gate::member(gate), origin);
        }
        for gate in wait::gates(component) {
            declare(C, wait::constant(&prefix, gate), Origin::gate(component, gate));
        }
    }
    found.extend(system.components.iter().flat_map(|component| enumeration::declarations(system, component, C)));
    found.extend(system.components.iter().flat_map(|component| parameters::declarations(system, component, C)));
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

/// All functions of a component and its gates.
fn functions(system: &System, component: &Component) -> Vec<Function> {
    let prefix = prefix(system, component);
    let of_gates = component.gates.iter().flat_map(|of| gate::functions(system, &prefix, of));
    let functions = component_functions(system, component).into_iter().chain(of_gates);
    functions.chain(wait::function(&prefix, component)).collect()
}

/// The prefix of a component's names: `rover_sensor`.
fn prefix(system: &System, component: &Component) -> String {
    format!("{}_{}", system.snake_name(), component.snake_name)
}

/// The messages that have structs, without duplicates.
fn messages(system: &System) -> Vec<crate::MessageUse> {
    let used = system.gates().flat_map(|gate| gate.types.iter().filter(|used| Content::of(gate, used).is_struct()));
    let by_name: BTreeMap<&str, &crate::MessageUse> = used.map(|used| (used.dotted.as_str(), used)).collect();
    by_name.into_values().cloned().collect()
}
