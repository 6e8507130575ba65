//! SCL0510: the same two gates connected twice. Removes the second connection, so that it does not count as another
//! peer.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Rule, Severity};
use std::collections::HashMap;

/// SCL0510.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0510",
    severity: Severity::Error,
    title: "duplicate connection",
    explanation: "The same two gates are connected twice; the order of the ends makes no difference. Each message \
                  would arrive twice. Remove one.",
    example: " components:
   - name: sensor
     gates:
       - measurements: pub
   - name: controller
     gates:
       - sensor: sub
 connections:
   - [sensor.measurements, controller.sensor]
-  - [controller.sensor, sensor.measurements]
",
};

pub(super) fn check(draft: &mut Draft<'_>, problems: &mut Diagnostics) {
    let mut first: HashMap<(usize, usize), usize> = HashMap::new();
    for at in 0..draft.links.len() {
        let [Some(a), Some(b)] = draft.links[at].ends else { continue };
        let earlier = *first.entry((a.min(b), a.max(b))).or_insert(at);
        if earlier == at {
            continue;
        }
        let same_order = draft.links[earlier].ends == draft.links[at].ends;
        let label = if same_order { "same two gates" } else { "same two gates, in the other order" };
        let span = draft.links[at].model.span;
        let found = RULE
            .at("this connection is already declared", span, label)
            .label(draft.links[earlier].model.span, "first declared here")
            .propose_removal("remove one of the two", draft.sources.file(span.file), span);
        problems.push(found);
        draft.links[at].flow = None;
        draft.links[at].ends = [None; 2];
    }
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn duplicate_connection() {
        rule_example(
            &RULE,
            expect![[r#"
            error: [SCL0510] this connection is already declared
              --> topology.yaml:10:5
               |
             9 |   - [sensor.measurements, controller.sensor]
               |     ---------------------------------------- first declared here
            10 |   - [controller.sensor, sensor.measurements]
               |     ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^ same two gates, in the other order
               |
               = help: remove one of the two
        "#]],
        );
    }
}
