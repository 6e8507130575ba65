//! SCL0308 for the enums of the senders of `sub` gates: `ControllerStatesSender`.

use super::named::{Name, Noun};
use super::rename::Renames;
use super::similar_name::{SAME_TYPE, Taken, owners, taken, with_other_name};
use crate::diagnostic::Diagnostics;
use crate::model::{ComponentModel, GateModel, Model};
use crate::rust_name::{component_type, gate_field};
use crate::senders::enum_name;
use crate::topology::GateKind;
use scl_text::gate_name::split;
use std::collections::{HashMap, HashSet};

/// Reports components and kinds with the name of such an enum, and gates whose enums would have one name. An enum of
/// the same name is generated for each, unless all senders are of one kind.
pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    let mut by_type: HashMap<String, (Noun, &Name)> = HashMap::new();
    let mut gates: HashMap<String, (&ComponentModel, &GateModel)> = HashMap::new();
    for (owner, gate) in gates_with_several_peers(model) {
        if by_type.is_empty() {
            by_type = owners(model).map(|(noun, name)| (component_type(&name.value), (noun, name))).collect();
        }
        let rust = enum_name(&owner.name.value, &gate.name.value);
        let path = format!("{}.{}", owner.name.value, gate.name.value);
        if let Some((noun, name)) = by_type.get(&rust) {
            let other = format!("sender_of_{}_{}", gate_field(&owner.name.value), gate_field(&gate.name.value));
            let what = format!("lists the senders of `{path}`");
            let taken_by = Taken { rust: &rust, what: &what, by: gate.name.span, end: "sender", other: &other };
            problems.push(taken(renames, *noun, name, &taken_by));
            continue;
        }
        let Some(&(first_owner, first)) = gates.get(&rust) else {
            gates.insert(rust, (owner, gate));
            continue;
        };
        let first_path = format!("{}.{}", first_owner.name.value, first.name.value);
        let headline =
            format!("the senders of `{first_path}` and of `{path}` would both become the Rust type `{rust}`");
        let found = SAME_TYPE
            .at(headline, gate.name.span, format!("its senders become `{rust}`"))
            .label(first.name.span, format!("its senders become `{rust}`, too"));
        problems.push(with_other_name(found, renames, Noun::Gate, &gate.name));
    }
}

/// The `sub` gates of which some component has several connections, each once, in the order of the connections.
fn gates_with_several_peers(model: &Model) -> Vec<(&ComponentModel, &GateModel)> {
    let (mut seen, mut several) = (HashSet::new(), Vec::new());
    for end in model.connections.iter().flat_map(|connection| &connection.ends) {
        if !seen.insert(end.value.as_str()) {
            several.push(end.value.as_str());
        }
    }
    if several.is_empty() {
        return Vec::new();
    }
    let by_name: HashMap<&str, &ComponentModel> =
        model.components.iter().map(|component| (component.name.value.as_str(), component)).collect();
    let mut told = HashSet::new();
    let gates = several.into_iter().filter_map(|end| {
        let (component, gate) = split(end)?;
        let component = *by_name.get(component)?;
        let owner = component.of.and_then(|kind| model.kinds.get(kind)).unwrap_or(component);
        let gate = owner.gates.iter().find(|it| it.name.value == gate)?;
        let is_sub = GateKind::of(&gate.kind.value) == Some(GateKind::Sub);
        (is_sub && told.insert(gate.name.span)).then_some((owner, gate))
    });
    gates.collect()
}

#[cfg(test)]
mod tests {
    use crate::check::testing::{codes, example};
    use expect_test::expect;

    const TAKEN: &str = "\
components:
  - {name: a, gates: [{out: pub}]}
  - {name: b, gates: [{out: pub}]}
  - {name: controller, gates: [{states: sub}]}
  - {name: controller_states_sender, gates: []}
connections:
  - [a.out, controller.states]
  - [b.out, controller.states]
";

    #[test]
    fn a_component_is_called_like_the_enum_of_senders() {
        example(
            "SCL0308",
            TAKEN,
            expect![[r#"
            error: [SCL0308] component `controller_states_sender` would become the Rust type `ControllerStatesSender`, which lists the senders of `controller.states`
             --> topology.yaml:5:12
              |
            4 |   - {name: controller, gates: [{states: sub}]}
              |                                 ------ gets `ControllerStatesSender` beside it
            5 |   - {name: controller_states_sender, gates: []}
              |            ^^^^^^^^^^^^^^^^^^^^^^^^ becomes `ControllerStatesSender`
              |
              = help: choose a name that does not end with `sender`, for example `sender_of_controller_states`
        "#]],
        );
        let one = TAKEN.replace("  - [b.out, controller.states]\n", "");
        assert!(!codes(&one).contains(&"SCL0308"), "one sender needs no enum");
    }

    #[test]
    fn two_gates_have_one_enum_of_senders() {
        let yaml = "\
components:
  - {name: a, gates: [{out: pub}]}
  - {name: b, gates: [{out: pub}]}
  - {name: x, gates: [{y_z: sub}]}
  - {name: x_y, gates: [{z: sub}]}
connections:
  - [a.out, x.y_z]
  - [b.out, x.y_z]
  - [a.out, x_y.z]
  - [b.out, x_y.z]
";
        example(
            "SCL0308",
            yaml,
            expect![[r#"
            error: [SCL0308] the senders of `x.y_z` and of `x_y.z` would both become the Rust type `XYZSender`
             --> topology.yaml:5:26
              |
            4 |   - {name: x, gates: [{y_z: sub}]}
              |                        --- its senders become `XYZSender`, too
            5 |   - {name: x_y, gates: [{z: sub}]}
              |                          ^ its senders become `XYZSender`
              |
              = help: rename one of them, for example `z` to `z_2`
        "#]],
        );
    }
}
