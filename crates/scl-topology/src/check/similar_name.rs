//! SCL0308 and SCL0309: names that differ in the file and would be one in Rust. SCL0310: names that only letter case
//! and `_` tell apart.

use super::named::{Name, is_well_formed, with_first};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field};
use std::collections::HashMap;

/// SCL0308.
pub(crate) const SAME_TYPE: Rule = Rule {
    code: "SCL0308",
    severity: Severity::Error,
    title: "two components become the same Rust type",
    explanation: "Different names in the file become the same Rust type: `user-interface` and `user_interface` both \
                  become `UserInterface`. If there is a component `sensor`, the type `SensorPeer` is taken, too: it is \
                  the counterpart that is generated for tests of `sensor`. Rename one.",
    example: " components:
-  - name: user-interface
+  - name: operator
     gates: []
   - name: user_interface
     gates: []
",
};

/// SCL0309.
pub(crate) const SAME_FIELD: Rule = Rule {
    code: "SCL0309",
    severity: Severity::Error,
    title: "two gates become the same Rust field",
    explanation: "Two gate names become the same Rust field: `set-point` and `setPoint` both become `set_point`. \
                  Rename one.",
    example: " components:
   - name: actuator
     gates:
       - set-point: sub
-      - setPoint: sub
+      - limit: sub
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    let names = model.components.iter().map(|component| &component.name);
    for (first, second, rust) in collisions(names, component_type) {
        let (a, b) = (&first.value, &second.value);
        let headline = format!("components `{a}` and `{b}` would both become the Rust type `{rust}`");
        let help = "rename one of them; use `_` in all names";
        problems.push(collision(&SAME_TYPE, headline, [first, second], &rust).help(help));
    }
    check_peers(model, problems);
    check_letter_case(model, problems);
    for component in &model.components {
        let names = component.gates.iter().map(|gate| &gate.name);
        for (first, second, rust) in collisions(names, gate_field) {
            let (a, b, owner) = (&first.value, &second.value, &component.name.value);
            let headline = format!("gates `{a}` and `{b}` of `{owner}` would both become the Rust field `{rust}`");
            problems.push(collision(&SAME_FIELD, headline, [first, second], &rust).help("rename one of them"));
        }
    }
}

/// Reports components named like a counterpart for tests, which the macro generates beside each component:
/// `ControllerPeer` for `Controller`.
fn check_peers(model: &Model, problems: &mut Diagnostics) {
    let names = model.components.iter().map(|component| &component.name).filter(|name| is_well_formed(&name.value));
    let by_type: HashMap<String, &Name> = names.rev().map(|name| (component_type(&name.value), name)).collect();
    for component in &model.components {
        let name = &component.name;
        let rust = component_type(&name.value);
        let Some(owner) = rust.strip_suffix("Peer").and_then(|owner| by_type.get(owner)) else { continue };
        let headline = format!(
            "component `{}` would become the Rust type `{rust}`, which is generated for tests of `{}`",
            name.value, owner.value
        );
        let found = SAME_TYPE
            .at(headline, name.span, format!("becomes `{rust}`"))
            .label(owner.span, format!("gets `{rust}` beside it"))
            .help("choose a name that does not end with `peer`");
        problems.push(found);
    }
}

/// The names that collide with an earlier, different name in Rust. Another rule reports equal names.
fn collisions<'m>(
    names: impl Iterator<Item = &'m Name>,
    rust: fn(&str) -> String,
) -> impl Iterator<Item = (&'m Name, &'m Name, String)> {
    let names = names.filter(|name| is_well_formed(&name.value));
    let different = with_first(names, rust).filter(|(first, name)| first.value != name.value);
    different.map(move |(first, name)| (first, name, rust(&name.value)))
}

fn collision(rule: &'static Rule, headline: String, [first, second]: [&Name; 2], rust: &str) -> Diagnostic {
    rule.at(headline, second.span, format!("also becomes `{rust}`")).label(first.span, format!("becomes `{rust}`"))
}

/// SCL0310.
pub(crate) const LETTER_CASE: Rule = Rule {
    code: "SCL0310",
    severity: Severity::Warning,
    title: "names that differ only in letter case",
    explanation: "Two names differ only in letter case, `_` or `-`. They are easily mixed up, become the same name in \
                  a language that spells names in another case, and would share a socket file on file systems that \
                  ignore case. Rename one.",
    example: " components:
   - name: gps
     gates: []
-  - name: GPS_
+  - name: receiver
     gates: []
",
};

fn check_letter_case(model: &Model, problems: &mut Diagnostics) {
    let components = model.components.iter().map(|component| &component.name);
    check_names("components", components, component_type, problems);
    for component in &model.components {
        check_names("gates", component.gates.iter().map(|gate| &gate.name), gate_field, problems);
    }
}

fn check_names<'m>(
    plural: &str,
    names: impl Iterator<Item = &'m Name>,
    rust: fn(&str) -> String,
    problems: &mut Diagnostics,
) {
    let names = names.filter(|name| is_well_formed(&name.value));
    // Two names that become the same Rust name are already an error.
    let alike = with_first(names, folded).filter(|(first, name)| rust(&first.value) != rust(&name.value));
    problems.extend(alike.map(|(first, name)| differ_in_case(plural, first, name)));
}

fn folded(name: &str) -> String {
    name.chars().filter(|&letter| letter != '_' && letter != '-').map(|letter| letter.to_ascii_lowercase()).collect()
}

fn differ_in_case(plural: &str, first: &Name, second: &Name) -> Diagnostic {
    let headline = format!("{plural} `{}` and `{}` differ only in letter case and `_`", first.value, second.value);
    LETTER_CASE
        .at(headline, second.span, "")
        .label(first.span, "")
        .help("rename one of them")
        .note("their socket files would be the same on a file system that ignores case (macOS, Windows)")
}

#[cfg(test)]
mod tests {
    use super::{LETTER_CASE, SAME_TYPE};
    use crate::check::testing::{example, rule_example};
    use expect_test::expect;

    #[test]
    fn two_components_become_the_same_rust_type() {
        rule_example(
            &SAME_TYPE,
            expect![[r#"
            error: [SCL0308] components `user-interface` and `user_interface` would both become the Rust type `UserInterface`
             --> topology.yaml:4:11
              |
            2 |   - name: user-interface
              |           -------------- becomes `UserInterface`
            3 |     gates: []
            4 |   - name: user_interface
              |           ^^^^^^^^^^^^^^ also becomes `UserInterface`
              |
              = help: rename one of them; use `_` in all names
        "#]],
        );
    }

    #[test]
    fn a_component_is_called_like_the_counterpart_of_another() {
        let yaml = r#"
components:
  - name: controller_peer
    gates: []
  - name: controller
    gates: []
"#;
        example(
            "SCL0308",
            yaml.trim_start(),
            expect![[r#"
                error: [SCL0308] component `controller_peer` would become the Rust type `ControllerPeer`, which is generated for tests of `controller`
                 --> topology.yaml:2:11
                  |
                2 |   - name: controller_peer
                  |           ^^^^^^^^^^^^^^^ becomes `ControllerPeer`
                3 |     gates: []
                4 |   - name: controller
                  |           ---------- gets `ControllerPeer` beside it
                  |
                  = help: choose a name that does not end with `peer`
            "#]],
        );
    }

    #[test]
    fn two_gates_become_the_same_rust_field() {
        let yaml = r#"
components:
  - name: actuator
    gates:
      - set-point: sub
      - setPoint: sub
"#;
        example(
            "SCL0309",
            yaml.trim_start(),
            expect![[r#"
            error: [SCL0309] gates `set-point` and `setPoint` of `actuator` would both become the Rust field `set_point`
             --> topology.yaml:5:9
              |
            4 |       - set-point: sub
              |         --------- becomes `set_point`
            5 |       - setPoint: sub
              |         ^^^^^^^^ also becomes `set_point`
              |
              = help: rename one of them
        "#]],
        );
    }

    #[test]
    fn names_that_differ_only_in_letter_case() {
        rule_example(
            &LETTER_CASE,
            expect![[r#"
            warning: [SCL0310] components `gps` and `GPS_` differ only in letter case and `_`
             --> topology.yaml:4:11
              |
            2 |   - name: gps
              |           ---
            3 |     gates: []
            4 |   - name: GPS_
              |           ^^^^
              |
              = help: rename one of them
              = note: their socket files would be the same on a file system that ignores case (macOS, Windows)
        "#]],
        );
    }
}
