//! SCL0301: two components of one name. Every place that names it would mean both.

use crate::diagnostic::{Diagnostics, Rule, Severity};
use crate::model::Model;
use std::collections::HashMap;

/// SCL0301.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0301",
    severity: Severity::Error,
    title: "duplicate component",
    explanation: "Two components have one name, so no connection could say which it means, and two programs would \
                  fight for one place. Rename one, or merge their gates.",
    example: " components:
   - name: sensor
     gates: []
-  - name: sensor
+  - name: sensor_2
     gates: []
",
};

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    let mut first = HashMap::new();
    for component in &model.components {
        let name = &component.name;
        let earlier = *first.entry(name.value.as_str()).or_insert(name);
        // Compared by place in the model: a name is its own first declaration.
        if !std::ptr::eq(earlier, name) {
            let headline = format!("component `{}` is declared twice", name.value);
            let found = RULE
                .at(headline, name.span, "second declaration")
                .label(earlier.span, "first declaration")
                .help("rename one of them, or merge their gates");
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
    fn duplicate_component() {
        rule_example(
            &RULE,
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
}
