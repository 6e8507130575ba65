//! SCL1601: a component with the name of a group, `left_arm` beside `left_arm.planner`. No text could say whether
//! `left_arm.planner` is a gate of the one or a component of the other.

use super::named::Noun;
use super::rename::Renames;
use crate::diagnostic::Diagnostics;
use crate::groups::TAKEN;
use crate::model::Model;
use scl_text::gate_name::groups_of;
use std::collections::HashMap;

pub(super) fn check<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    // The first component in each group.
    let mut groups = HashMap::new();
    for component in &model.components {
        for group in groups_of(&component.name.value) {
            groups.entry(group).or_insert(&component.name);
        }
    }
    for component in model.components.iter().filter(|_| !groups.is_empty()) {
        let name = &component.name;
        let Some(member) = groups.get(name.value.as_str()) else { continue };
        let other = format!("{}.main", name.value);
        let found = TAKEN
            .at(format!("component `{}` has the name of a group", name.value), name.span, "")
            .label(member.span, format!("`{}` is in the group `{}`", member.value, name.value))
            .suggest(
                format!("move it into the group, for example as `{other}`"),
                renames.edits(Noun::Component, name, &other),
            );
        problems.push(found.help("or give the component or the group another name"));
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::{advice, codes, rule_example};
    use crate::groups::TAKEN;
    use expect_test::expect;

    #[test]
    fn component_has_the_name_of_a_group() {
        rule_example(
            &TAKEN,
            expect![[r#"
            error: [SCL1601] component `left_arm` has the name of a group
             --> topology.yaml:2:11
              |
            2 |   - name: left_arm
              |           ^^^^^^^^
            3 |     gates: []
            4 |   - name: left_arm.planner
              |           ---------------- `left_arm.planner` is in the group `left_arm`
              |
              = help: move it into the group, for example as `left_arm.main`
              = help: or give the component or the group another name
        "#]],
        );
    }

    #[test]
    fn groups_in_groups_have_names_of_their_own() {
        let file = |name: &str| {
            format!("components:\n  - {{name: a.b.c, gates: []}}\n  - {{name: '{name}', gates: []}}\nconnections: []\n")
        };
        for name in ["a", "a.b"] {
            assert!(codes(&file(name)).contains(&"SCL1601"), "{name}");
        }
        for name in ["b", "c", "a.c", "a.b.d", "b.c", "a.bc"] {
            assert!(!codes(&file(name)).contains(&"SCL1601"), "{name}");
        }
    }

    #[test]
    fn ends_name_components_in_groups() {
        let file = |end: &str| {
            format!(
                "components:\n  - {{name: arm.planner, gates: [{{command: {{sub: T}}}}]}}\n  \
                 - {{name: pilot, gates: [{{arm: {{pub: T}}}}]}}\nconnections:\n  - [pilot.arm, '{end}']\n"
            )
        };
        assert_eq!(advice(&file("arm.planner.command")), "");
        let ends = [
            "arm.plannr.command",
            "arm.planner.comand",
            "planner.command",
            "arm.planner",
            "arm.command",
            "arm/planner/command",
            "left.arm.planner.command",
            "arm.planner.hand.command",
            "arm",
            "arms.planner.command",
        ];
        let told: String = ends.iter().map(|end| format!("{end}: {}\n", advice(&file(end)))).collect();
        expect![[r#"
            arm.plannr.command: SCL0501 unknown component `arm.plannr` [did you mean `arm.planner`? | or rename the component `arm.planner` to `arm.plannr`]
            arm.planner.comand: SCL0502 component `arm.planner` has no gate `comand` [did you mean `command`? | or rename the gate `command` to `comand`]
            planner.command: SCL0501 unknown component `planner` [did you mean `arm.planner`? | or rename the component `arm.planner` to `planner`]
            arm.planner: SCL0503 a connection end is written `component.gate` [write `arm.planner.command`]
            arm.command: SCL0501 unknown component `arm` [did you mean `arm.planner`?]
            arm/planner/command: SCL0503 a connection end is written `component.gate` [write `arm.planner.command`]
            left.arm.planner.command: SCL0501 unknown component `left.arm.planner` [did you mean `arm.planner`? | or rename the component `arm.planner` to `left.arm.planner`]
            arm.planner.hand.command: SCL0501 unknown component `arm.planner.hand` [did you mean `arm.planner`? | or rename the component `arm.planner` to `arm.planner.hand`]
            arm: SCL0503 a connection end is written `component.gate` [gates of this name: `pilot.arm`]
            arms.planner.command: SCL0501 unknown component `arms.planner` [did you mean `arm.planner`? | or rename the component `arm.planner` to `arms.planner`]
        "#]].assert_eq(&told);
    }
}
