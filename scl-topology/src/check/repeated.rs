//! An unknown name that several connections use is one mistake, most often that of its declaration: it is told at the
//! first of them, and the others are shown there.

use super::{unknown_component, unknown_gate};
use crate::diagnostic::Diagnostics;
use crate::source::Span;
use std::collections::HashMap;

/// One problem shows no more places.
const MOST: usize = 8;

pub(super) fn tell_once(problems: &mut Diagnostics) {
    let mut places: HashMap<String, Vec<Span>> = HashMap::new();
    problems.retain(|found| {
        if ![&unknown_component::UNKNOWN, &unknown_gate::RULE].contains(&found.rule) {
            return true;
        }
        let uses = places.entry(found.message.clone()).or_default();
        uses.extend(found.primary.as_ref().map(|label| label.span));
        uses.len() <= 1
    });
    problems.retain(|found| {
        let uses = places.get(&found.message).map_or(&[][..], |uses| uses.get(1..).unwrap_or(&[]));
        for place in uses.iter().take(MOST) {
            found.add_label(*place, "and here");
        }
        if !uses.is_empty() {
            found.notes.push(format!("{} connections name it", uses.len() + 1));
        }
        true
    });
}

#[cfg(test)]
mod tests {
    use crate::check::testing::example;
    use expect_test::expect;

    #[test]
    fn a_misspelt_declaration_is_one_mistake() {
        let yaml = "
components:
  - name: contoller
    gates:
      - a: sub
      - b: sub
  - name: sensor
    gates:
      - a: pub
      - b: pub
connections:
  - [sensor.a, controller.a]
  - [sensor.b, controller.b]
";
        example(
            "SCL0501",
            yaml.trim_start(),
            expect![[r#"
            error: [SCL0501] unknown component `controller`
              --> topology.yaml:11:16
               |
             2 |   - name: contoller
               |           --------- a similar name is declared here
            ...
            11 |   - [sensor.a, controller.a]
               |                ^^^^^^^^^^ no component has this name
            12 |   - [sensor.b, controller.b]
               |                ---------- and here
               |
               = help: did you mean `contoller`?
               = note: declared components: `contoller`, `sensor`
               = note: 2 connections name it
        "#]],
        );
    }
}
