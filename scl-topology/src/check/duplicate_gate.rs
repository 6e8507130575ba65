//! SCL0302: two gates of one name in a component. A connection could not say which it means.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::{ComponentModel, Model};
use std::collections::HashMap;

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    for component in &model.components {
        check_component(component, problems);
    }
}

fn check_component(component: &ComponentModel, problems: &mut Diagnostics) {
    let mut first = HashMap::new();
    for gate in &component.gates {
        let name = &gate.name;
        let first = *first.entry(name.value.as_str()).or_insert(name.span);
        if first != name.span {
            let headline = format!("component `{}` declares gate `{}` twice", component.name.value, name.value);
            let found = Diagnostic::error("SCL0302", headline, name.span, "second declaration")
                .label(first, "first declaration")
                .help("gate names are unique within a component, whatever their kind");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn duplicate_gate() {
        let yaml = r#"
components:
  - name: controller
    gates:
      - sensor: sub
      - sensor: pub
"#;
        example(
            "SCL0302",
            yaml.trim_start(),
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
