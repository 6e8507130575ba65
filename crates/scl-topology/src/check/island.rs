//! SCL0706, a lint: groups of components without a connection between them, which may be two systems in one file.

use super::draft::Draft;
use crate::diagnostic::{Diagnostic, Diagnostics, Rule, Severity};
use scl_text::list::listed;
use std::collections::BTreeMap;

/// SCL0706.
pub(crate) const RULE: Rule = Rule {
    code: "SCL0706",
    severity: Severity::Lint,
    title: "system consists of unconnected groups",
    explanation: "The components form groups with no connection between them. Either the file describes several \
                  systems, or a connection is missing. Put separate systems into separate files.",
    example: " components:
   - name: a
     gates:
       - x: pub
   - name: b
     gates:
       - x: sub
   - name: c
     gates:
       - y: pub
   - name: d
     gates:
       - y: sub
+      - x: sub
 connections:
   - [a.x, b.x]
   - [c.y, d.y]
+  - [a.x, d.x]
",
};

/// Maximum number of groups shown.
const MOST: usize = 8;

pub(super) fn check(draft: &Draft<'_>, problems: &mut Diagnostics) {
    // A connection that could not be read may be the one that joins two groups.
    let is_whole = draft.links.iter().all(|link| link.flow.is_some()) && draft.model.broken_ends.is_empty();
    let groups = groups(draft);
    if is_whole && groups.len() > 1 {
        problems.push(report(draft, &groups));
    }
}

/// The connected components in groups, each in file order. Another rule reports components without any connection.
fn groups(draft: &Draft<'_>) -> Vec<Vec<usize>> {
    let mut parent: Vec<usize> = (0..draft.components.len()).collect();
    let mut connected = vec![false; parent.len()];
    for (_, source, sink) in draft.flows() {
        let ends = [source, sink].map(|gate| draft.gates[gate].component);
        ends.iter().for_each(|&end| connected[end] = true);
        let [a, b] = ends.map(|end| root(&mut parent, end));
        parent[a.max(b)] = a.min(b);
    }
    let mut groups: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for component in (0..parent.len()).filter(|&component| connected[component]) {
        groups.entry(root(&mut parent, component)).or_default().push(component);
    }
    groups.into_values().collect()
}

/// Returns the first component of a group, and halves the path to it for later calls.
fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}

fn report(draft: &Draft<'_>, groups: &[Vec<usize>]) -> Diagnostic {
    let name = |&component: &usize| &draft.components[component].model.name;
    let label = |at: usize| format!("group {}: {}", at + 1, listed(groups[at].iter().map(|one| &name(one).value)));
    let place = |at: usize| name(&groups[at][0]).span;
    let count = groups.len();
    let headline = format!("the topology consists of {count} groups of components with no connection between them");
    let others = (0..count.min(MOST)).filter(|&at| at != 1);
    let found = RULE.at(headline, place(1), label(1)).labels(others.map(|at| (place(at), label(at))));
    let systems = if count == 2 { "two systems, put them into two files" } else { "several systems, give each a file" };
    found.help(format!("if they are {systems}"))
}

#[cfg(test)]
mod tests {
    use super::RULE;
    use crate::check::testing::rule_example;
    use expect_test::expect;

    #[test]
    fn the_system_falls_apart_into_islands() {
        rule_example(
            &RULE,
            expect![[r#"
                warning: [SCL0706] the topology consists of 2 groups of components with no connection between them
                 --> topology.yaml:8:11
                  |
                2 |   - name: a
                  |           - group 1: `a`, `b`
                ...
                8 |   - name: c
                  |           ^ group 2: `c`, `d`
                  |
                  = help: if they are two systems, put them into two files
            "#]],
        );
    }
}
