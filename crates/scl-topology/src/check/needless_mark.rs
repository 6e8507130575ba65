//! SCL0711: `unconnected: ok` on a gate that is connected. If the connection were removed later, the mark would hide
//! it.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Rule, Severity};

/// SCL0711.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0711",
    severity: Severity::Warning,
    title: "`unconnected: ok` on a connected gate",
    explanation: "The gate is marked as one without a peer, but it has one. If the connection is removed later, the \
                  mark would hide that. Remove the mark.",
    example: " components:
   - name: controller
     gates:
-      - events: {pub: Event, unconnected: ok}
+      - events: {pub: Event}
   - name: ui
     gates:
       - events: {sub: Event}
 connections:
   - [controller.events, ui.events]
",
};

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    let mut connected_at = vec![None; draft.gates.len()];
    for link in &draft.links {
        for gate in link.ends.into_iter().flatten() {
            connected_at[gate].get_or_insert(link.model.span);
        }
    }
    // The mark of a kind is for any of its components.
    let mut is_needed = vec![false; draft.gates.len()];
    for (gate, _) in connected_at.iter().enumerate().filter(|(_, connected_at)| connected_at.is_none()) {
        is_needed[draft.shared(gate)] = true;
    }
    for (at, gate) in draft.gates.iter().enumerate().filter(|(at, _)| !is_needed[draft.shared(*at)]) {
        let (Some(option), Some(connected_at)) = (gate.option("unconnected"), connected_at[at]) else { continue };
        if gate.options.unconnected_ok {
            let headline = format!("gate `{}` is marked `unconnected: ok`, but it is connected", draft.path(at));
            let place = option.key.span.to(option.value.span);
            let found = RULE
                .at(headline, place, "no longer needed")
                .label(connected_at, "connected here")
                .propose_removal("remove the mark", draft.sources.file(place.file), place);
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
    fn unconnected_ok_on_a_connected_gate() {
        rule_example(
            &RULE,
            expect![[r#"
            warning: [SCL0711] gate `controller.events` is marked `unconnected: ok`, but it is connected
             --> topology.yaml:4:30
              |
            4 |       - events: {pub: Event, unconnected: ok}
              |                              ^^^^^^^^^^^^^^^ no longer needed
            ...
            9 |   - [controller.events, ui.events]
              |     ------------------------------ connected here
              |
              = help: remove the mark
        "#]],
        );
    }
}
