//! SCL0308 and SCL0309: names that differ in the file and would be one in Rust. SCL0310: names that only letter case
//! and `_` tell apart.

use super::merge;
use super::named::{Name, Noun, types, with_first};
use super::rename::Renames;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;
use crate::rust_name::{component_type, gate_field};
use crate::source::{Sources, Span};
use std::collections::HashMap;

/// SCL0308.
pub(crate) const SAME_TYPE: Rule = Rule {
    code: "SCL0308",
    severity: Severity::Error,
    title: "two components become the same Rust type",
    explanation: "Different names in the file become the same Rust type: `user-interface` and `user_interface` both \
                  become `UserInterface`. If there is a component `sensor`, the type `SensorPeer` is taken, too: it is \
                  the counterpart that is generated for tests of `sensor`. Beside a kind `motor`, `MotorInstance` is \
                  the enum of its components, and beside a `sub` gate `controller.states` with several peers, \
                  `ControllerStatesSender` is the enum of its senders. Rename one.",
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

/// Maximum number of problems of one kind for which a change is searched.
const MOST_SEARCHES: usize = 16;

pub(super) fn check<'m>(model: &'m Model, sources: &Sources, renames: &Renames<'m>, problems: &mut Diagnostics) {
    let names = types(model).map(|(_, name)| name);
    for (number, (first, second, rust)) in collisions(Noun::Component, names, component_type).enumerate() {
        let nouns = [first, second].map(|name| noun_of(model, name));
        let headline = format!("{} would both become the Rust type `{rust}`", pair(nouns, first, second));
        let mut found = collision(&SAME_TYPE, headline, [first, second], &rust);
        if number < MOST_SEARCHES {
            let of = |name: &Name| model.components.iter().find(|component| std::ptr::eq(&component.name, name));
            if let (Some(first), Some(second)) = (of(first), of(second)) {
                found = merge::suggest(found, model, sources, [first, second]);
            }
        }
        problems.push(with_other_name(found, renames, nouns[1], second));
    }
    check_beside(model, renames, problems);
    check_letter_case(model, renames, problems);
    for owner in model.owners() {
        let names = owner.gates.iter().map(|gate| &gate.name);
        for (first, second, rust) in collisions(Noun::Gate, names, gate_field) {
            let (a, b, owner) = (&first.value, &second.value, &owner.name.value);
            let headline = format!("gates `{a}` and `{b}` of `{owner}` would both become the Rust field `{rust}`");
            let found = collision(&SAME_FIELD, headline, [first, second], &rust);
            problems.push(with_other_name(found, renames, Noun::Gate, second));
        }
    }
}

fn noun_of(model: &Model, name: &Name) -> Noun {
    let is_kind = model.kinds.iter().any(|kind| std::ptr::eq(&kind.name, name));
    if is_kind { Noun::Kind } else { Noun::Component }
}

/// Two names in a message: ``components `gps` and `GPS` ``.
fn pair(nouns: [Noun; 2], first: &Name, second: &Name) -> String {
    let (a, b) = (&first.value, &second.value);
    match nouns {
        [one, two] if one == two => format!("{}s `{a}` and `{b}`", one.word()),
        [one, two] => format!("{} `{a}` and {} `{b}`", one.word(), two.word()),
    }
}

/// Suggests a number at the end of a name.
pub(super) fn with_other_name<'m>(found: Diagnostic, renames: &Renames<'m>, noun: Noun, name: &'m Name) -> Diagnostic {
    let other = format!("{}_2", gate_field(&name.value).trim_end_matches('_'));
    let or = if found.helps.is_empty() { "" } else { "or " };
    let help = format!("{or}rename one of them, for example `{}` to `{other}`", name.value);
    found.suggest(help, renames.edits(noun, name, &other)).otherwise("rename one of them")
}

/// Types that the macro generates beside others: the ends of their names, whether only kinds have one, what it is.
const BESIDE: [(&str, bool, &str); 2] =
    [("Peer", false, "is generated for tests of"), ("Instance", true, "lists the components of the kind")];

/// Reports components and kinds with the name of a type that the macro generates beside another one: `ControllerPeer`
/// beside `Controller`, and `MotorInstance` beside the kind `Motor`.
fn check_beside<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    let well_formed = owners(model).filter(|(noun, name)| noun.is_well_formed(&name.value));
    let by_type: HashMap<String, (Noun, &Name)> =
        well_formed.rev().map(|(noun, name)| (component_type(&name.value), (noun, name))).collect();
    for (noun, name) in owners(model) {
        let rust = component_type(&name.value);
        let beside = BESIDE.iter().find_map(|(end, only_kinds, what)| {
            let (noun, owner) = by_type.get(rust.strip_suffix(end)?)?;
            (!only_kinds || *noun == Noun::Kind).then_some((end.to_lowercase(), what, owner))
        });
        let Some((end, what, owner)) = beside else { continue };
        let what = format!("{what} `{}`", owner.value);
        let other = format!("{end}_of_{}", gate_field(&owner.value));
        let taken_by = Taken { rust: &rust, what: &what, by: owner.span, end: &end, other: &other };
        problems.push(taken(renames, noun, name, &taken_by));
    }
}

/// Kinds, and components of no kind: the others become variants of the enum of their kind.
pub(super) fn owners(model: &Model) -> impl DoubleEndedIterator<Item = (Noun, &Name)> {
    let kinds = model.kinds.iter().map(|kind| (Noun::Kind, &kind.name));
    let components = model.components.iter().filter(|component| component.of.is_none());
    kinds.chain(components.map(|component| (Noun::Component, &component.name)))
}

/// A type that the macro generates beside another one.
pub(super) struct Taken<'a> {
    /// Its name.
    pub(super) rust: &'a str,
    /// What it is: `` is generated for tests of `controller` ``.
    pub(super) what: &'a str,
    /// The name beside which it is generated.
    pub(super) by: Span,
    /// The word with which names should not end, and a name without it.
    pub(super) end: &'a str,
    pub(super) other: &'a str,
}

/// A component or kind with the name of such a type.
pub(super) fn taken<'m>(renames: &Renames<'m>, noun: Noun, name: &'m Name, taken: &Taken<'_>) -> Diagnostic {
    let Taken { rust, what, by, end, other } = taken;
    let headline = format!("{} `{}` would become the Rust type `{rust}`, which {what}", noun.word(), name.value);
    let without = format!("choose a name that does not end with `{end}`");
    SAME_TYPE
        .at(headline, name.span, format!("becomes `{rust}`"))
        .label(*by, format!("gets `{rust}` beside it"))
        .suggest(format!("{without}, for example `{other}`"), renames.edits(noun, name, other))
        .otherwise(without)
}

/// The names that collide with an earlier, different name in Rust. Another rule reports equal names.
fn collisions<'m>(
    noun: Noun,
    names: impl Iterator<Item = &'m Name>,
    rust: fn(&str) -> String,
) -> impl Iterator<Item = (&'m Name, &'m Name, String)> {
    let names = names.filter(move |name| noun.is_well_formed(&name.value));
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

fn check_letter_case<'m>(model: &'m Model, renames: &Renames<'m>, problems: &mut Diagnostics) {
    let names = types(model).map(|(_, name)| name);
    check_names(|name| noun_of(model, name), names, component_type, renames, problems);
    for owner in model.owners() {
        check_names(|_| Noun::Gate, owner.gates.iter().map(|gate| &gate.name), gate_field, renames, problems);
    }
}

fn check_names<'m>(
    noun: impl Fn(&Name) -> Noun,
    names: impl Iterator<Item = &'m Name>,
    rust: fn(&str) -> String,
    renames: &Renames<'m>,
    problems: &mut Diagnostics,
) {
    let names = names.filter(|name| noun(name).is_well_formed(&name.value));
    // Two names that become the same Rust name are already an error.
    let alike = with_first(names, folded).filter(|(first, name)| rust(&first.value) != rust(&name.value));
    for (first, name) in alike {
        let nouns = [noun(first), noun(name)];
        problems.push(with_other_name(differ_in_case(nouns, first, name), renames, nouns[1], name));
    }
}

fn folded(name: &str) -> String {
    name.chars().filter(|&letter| letter != '_' && letter != '-').map(|letter| letter.to_ascii_lowercase()).collect()
}

fn differ_in_case(nouns: [Noun; 2], first: &Name, second: &Name) -> Diagnostic {
    let headline = format!("{} differ only in letter case and `_`", pair(nouns, first, second));
    LETTER_CASE
        .at(headline, second.span, "")
        .label(first.span, "")
        .note("their socket files would be the same on a file system that ignores case (macOS, Windows)")
}

#[cfg(test)]
mod tests {
    use super::{LETTER_CASE, SAME_TYPE};
    use crate::check::testing::{codes, example, rule_example};
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
                  = help: rename one of them, for example `user_interface` to `user_interface_2`
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
                  = help: choose a name that does not end with `peer`, for example `peer_of_controller`
            "#]],
        );
    }

    #[test]
    fn a_component_is_called_like_the_enum_of_a_kind() {
        let kind = "kinds:\n  - name: motor\n    gates: []\ncomponents:\n  - {name: a, kind: motor}\n";
        let taken = format!("{kind}  - {{name: motor_instance, gates: []}}\nconnections: []\n");
        example(
            "SCL0308",
            &taken,
            expect![[r#"
            error: [SCL0308] component `motor_instance` would become the Rust type `MotorInstance`, which lists the components of the kind `motor`
             --> topology.yaml:6:12
              |
            2 |   - name: motor
              |           ----- gets `MotorInstance` beside it
            ...
            6 |   - {name: motor_instance, gates: []}
              |            ^^^^^^^^^^^^^^ becomes `MotorInstance`
              |
              = help: choose a name that does not end with `instance`, for example `instance_of_motor`
        "#]],
        );
        let of_the_kind = taken.replace("gates: []}", "kind: motor}");
        assert!(!codes(&of_the_kind).contains(&"SCL0308"), "it becomes a variant");
        let free = "components:\n  - {name: motor, gates: []}\n  - {name: motor_instance, gates: []}\n";
        assert!(!codes(free).contains(&"SCL0308"), "only kinds have an enum");
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
                  = help: rename one of them, for example `setPoint` to `set_point_2`
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
                  = help: rename one of them, for example `GPS_` to `gps_2`
                  = note: their socket files would be the same on a file system that ignores case (macOS, Windows)
            "#]],
        );
    }
}
