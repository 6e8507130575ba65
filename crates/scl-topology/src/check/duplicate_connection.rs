//! SCL0510: the same two gates connected twice. Removes the second connection, so that it does not count as another
//! peer.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Edit, Rule, Severity};
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

/// Maximum number of gates that a search looks at, and that a help names.
const SEARCHED: usize = 32;
const MOST: usize = 2;

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
            .label(draft.links[earlier].model.span, "first declared here");
        let meant = meant(draft, at, [a, b]);
        let mut found = meant.iter().fold(found, |found, &(end, gate)| {
            let (place, path) = (draft.links[at].model.ends[end].span, draft.path(gate));
            let edit = Edit::new(place, draft.sources.quoted_as(place, &path));
            found.suggest(format!("write `{path}`, which is not connected yet"), [edit])
        });
        found = found.propose_removal("remove one of the two", draft.sources.file(span.file), span);
        if !meant.is_empty() {
            found.doubt();
        }
        problems.push(found);
        meant.into_iter().for_each(|(_, gate)| draft.gates[gate].named = true);
        draft.links[at].flow = None;
        draft.links[at].ends = [None; 2];
    }
}

/// Unconnected gates with the name of one of the ends that fit the other end, with the number of the end: a copied line
/// of which the component was not changed.
fn meant(draft: &Draft<'_>, link: usize, ends: [usize; 2]) -> Vec<(usize, usize)> {
    let candidates = [0, 1].into_iter().flat_map(|end| {
        let (gate, other) = (ends[end], ends[1 - end]);
        let name = draft.gates[gate].model.name.value.as_str();
        let same = draft.gates_named(name).iter().copied().take(SEARCHED);
        let is_open = move |at: &usize| {
            let of = draft.component_name(*at);
            !draft.gates[*at].named && of != draft.component_name(other) && draft.may_connect(other, *at)
        };
        same.filter(is_open).map(move |gate| (usize::from(draft.links[link].ends[0] != Some(ends[end])), gate))
    });
    candidates.take(MOST).collect()
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
