//! SCL0510: the same two gates connected twice. Removes the second connection, so that it does not count as another
//! peer.

use super::draft::Draft;
use crate::diagnostic::{Diagnostics, Edit, Rule, Severity};
use crate::topology::GateKind;
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
        let ends = draft.links[at].ends.map(|end| end.unwrap_or(a));
        let is_written = !draft.links[at].model.from_everyone;
        let meant = if is_written && draft.may_search() { meant(draft, ends) } else { Vec::new() };
        let mut found = meant.iter().fold(found, |found, pair| {
            let paths = pair.map(|gate| draft.path(gate));
            let places = draft.links[at].model.ends.iter().zip(pair.iter().zip(ends)).zip(&paths);
            let changed = places.filter(|((_, (new, old)), _)| *new != old);
            let edits = changed.map(|((end, _), path)| Edit::new(end.span, draft.sources.quoted_as(end.span, path)));
            found.suggest(format!("write `[{}]`", paths.join(", ")), edits)
        });
        // The other connections of an `each` and of `everyone` are needed.
        let written = [at, earlier].into_iter().filter(|link| !draft.links[*link].model.from_everyone);
        let alone = |link: &usize| draft.links[*link].model.each == [None, None];
        let needless = written.clone().find(alone).or(written.clone().next()).unwrap_or(at);
        let needless = draft.links[needless].model.span;
        found = found.propose_removal("remove one of the two", draft.sources.file(needless.file), needless);
        if !meant.is_empty() {
            found.doubt();
        }
        // Two gates of one name, one of which sends and the other receives, have both connections.
        let is_contradictory = |gate: usize| {
            draft.gates[gate].kind.is_none() && GateKind::of(&draft.gates[gate].model.kind.value).is_some()
        };
        if same_order || ![a, b].into_iter().any(is_contradictory) {
            problems.push(found);
        }
        meant.into_iter().flatten().for_each(|gate| draft.gates[gate].named = true);
        draft.links[at].flow = None;
        draft.links[at].ends = [None; 2];
    }
}

/// The pairs that a copied line may mean: unconnected gates that fit each other, of several those with the same number,
/// else one unconnected gate with one end as it is.
fn meant(draft: &Draft<'_>, ends: [usize; 2]) -> Vec<[usize; 2]> {
    let name = |gate: usize| draft.gates[gate].model.name.value.as_str();
    let open = |gate: usize| {
        let namesakes = draft.gates_named(name(gate)).iter().copied();
        let own = draft.gates_of(draft.component_name(gate));
        let siblings = own.filter(move |at| words(name(*at)).eq(words(name(gate))) && *at != gate);
        let all = namesakes.take(SEARCHED).chain(siblings.take(SEARCHED));
        all.filter(|at| !draft.gates[*at].named && !draft.gates[*at].duplicate).collect::<Vec<usize>>()
    };
    let fits = |[a, b]: &[usize; 2]| draft.component_name(*a) != draft.component_name(*b) && draft.may_connect(*a, *b);
    let number = |gate: usize| draft.path(gate).chars().filter(char::is_ascii_digit).collect::<String>();
    let [first, second] = ends.map(open);
    let pairs = first.iter().flat_map(|a| second.iter().map(move |b| [*a, *b]));
    let mut pairs: Vec<[usize; 2]> = pairs.filter(fits).take(SEARCHED).collect();
    if pairs.len() > 1 {
        pairs.retain(|[a, b]| number(*a) == number(*b));
        pairs.truncate(MOST);
    }
    if !pairs.is_empty() {
        return pairs;
    }
    let singles = first.into_iter().map(|a| [a, ends[1]]).chain(second.into_iter().map(|b| [ends[0], b]));
    singles.filter(fits).take(MOST).collect()
}

/// A name without its digits.
fn words(name: &str) -> impl Iterator<Item = char> {
    name.chars().filter(|letter| !letter.is_ascii_digit())
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
