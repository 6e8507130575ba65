//! SCL0301: two components of one name. Every place that names it would mean both.

use crate::diagnostic::{Diagnostic, Diagnostics};
use crate::model::Model;
use std::collections::HashMap;

pub(super) fn check(model: &Model, problems: &mut Diagnostics) {
    let mut first = HashMap::new();
    for component in &model.components {
        let name = &component.name;
        let first = *first.entry(name.value.as_str()).or_insert(name.span);
        if first != name.span {
            let headline = format!("component `{}` is declared twice", name.value);
            let found = Diagnostic::error("SCL0301", headline, name.span, "second declaration")
                .label(first, "first declaration")
                .help("rename one of them, or merge their gates");
            problems.push(found);
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn duplicate_component() {
        let yaml = r#"
components:
  - name: sensor
    gates: []
  - name: sensor
    gates: []
"#;
        example(
            "SCL0301",
            yaml.trim_start(),
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
