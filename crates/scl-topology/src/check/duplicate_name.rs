//! SCL0301: two components of one name. SCL0302: two gates of one name in a component. A connection could not say which
//! it means.

use super::named::{Name, with_first};
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use crate::model::Model;

/// SCL0301.
pub(crate) const COMPONENT: Rule = Rule {
    code: "SCL0301",
    severity: Severity::Error,
    title: "duplicate component",
    explanation: "Two components have the same name, so a connection could not say which one it means, and their \
                  programs could not run at the same time. Rename one, or merge their gates.",
    example: " components:
   - name: sensor
     gates: []
-  - name: sensor
+  - name: sensor_2
     gates: []
",
};

/// SCL0302.
pub(crate) const GATE: Rule = Rule {
    code: "SCL0302",
    severity: Severity::Error,
    title: "duplicate gate",
    explanation: "Two gates of a component have the same name. Even if their kinds differ, neither a connection nor a \
                  program could say which one it means. Rename one.",
    example: " components:
   - name: controller
     gates:
       - sensor: sub
-      - sensor: pub
+      - sensor_2: pub
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for (first, second) in repeated(model.components.iter().map(|component| &component.name)) {
        let headline = format!("component `{}` is declared twice", second.value);
        let found = report(&COMPONENT, headline, first, second);
        problems.push(found.help("rename one of them, or merge their gates"));
    }
    for component in &model.components {
        for (first, second) in repeated(component.gates.iter().map(|gate| &gate.name)) {
            let headline = format!("component `{}` declares gate `{}` twice", component.name.value, second.value);
            let found = report(&GATE, headline, first, second);
            problems.push(found.help("gate names are unique within a component, whatever their kind"));
        }
    }
}

/// Returns each repeated name, preceded by its first occurrence.
fn repeated<'m>(names: impl Iterator<Item = &'m Name>) -> impl Iterator<Item = (&'m Name, &'m Name)> {
    // Compare addresses: `with_first` pairs the first declaration with itself.
    with_first(names, |name| name).filter(|(first, name)| !std::ptr::eq(*first, *name))
}

fn report(rule: &'static Rule, headline: String, first: &Name, second: &Name) -> Diagnostic {
    rule.at(headline, second.span, "second declaration").label(first.span, "first declaration")
}

#[cfg(test)]
mod tests {
    use super::{COMPONENT, GATE};
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn duplicate_component() {
        rule_example(
            &COMPONENT,
            expect![[r#"
            error: [SCL0301] component `sensor` is declared twice
             --> topology.yaml:4:11
              |
            2 |   - name: sensor
              |           ------ first declaration
            3 |     gates: []
            4 |   - name: sensor
              |           ^^^^^^ second declaration
              |
              = help: rename one of them, or merge their gates
        "#]],
        );
    }

    #[test]
    fn duplicate_gate() {
        rule_example(
            &GATE,
            expect![[r#"
            error: [SCL0302] component `controller` declares gate `sensor` twice
             --> topology.yaml:5:9
              |
            4 |       - sensor: sub
              |         ------ first declaration
            5 |       - sensor: pub
              |         ^^^^^^ second declaration
              |
              = help: gate names are unique within a component, whatever their kind
        "#]],
        );
    }
}
