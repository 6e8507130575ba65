//! SCL0302: two gates of one name in a component. A connection could not say which it means.

use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::{ComponentModel, Model};
use std::collections::HashMap;

/// SCL0302.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0302",
    severity: Severity::Error,
    title: "duplicate gate",
    explanation: "Two gates of a component have one name, be their kinds equal or not. A connection could not say \
                  which it means, nor could a program. Rename one.",
    example: " components:
   - name: controller
     gates:
       - sensor: sub
-      - sensor: pub
+      - sensor_2: pub
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for component in &model.components {
        check_component(component, problems);
    }
}

fn check_component(component: &ComponentModel, problems: &mut Diagnostics) {
    let mut first = HashMap::new();
    for gate in &component.gates {
        let name = &gate.name;
        let earlier = *first.entry(name.value.as_str()).or_insert(name);
        // Compared by place in the model: a name is its own first declaration.
        if !std::ptr::eq(earlier, name) {
            let headline = format!("component `{}` declares gate `{}` twice", component.name.value, name.value);
            let found = RULE
                .at(headline, name.span, "second declaration")
                .label(earlier.span, "first declaration")
                .help("gate names are unique within a component, whatever their kind");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn duplicate_gate() {
        rule_example(
            &RULE,
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
