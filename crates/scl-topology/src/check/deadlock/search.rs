//! Finds the deadlocks in a set of waits, in linear time.
//!
//! A set of components is deadlocked if each of them has a wait for members of the set only: then no member can end the
//! wait of another. Waits for a single component form circles; a deadlock with a wait that shares work is a closed
//! knot.

use crate::check::circles::{Graph, Step};
use crate::check::waits::Wait;
use crate::work;
use std::collections::BTreeMap;

/// Components that wait for each other.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Deadlock {
    /// The steps of a circle in turn; for a knot, the steps of one wait of each of its components, in file order.
    pub(super) steps: Vec<Step>,
    pub(super) is_circle: bool,
    /// Whether the same components have more deadlocks than are reported.
    pub(super) has_others: bool,
}

/// Returns circles of waits for a single component that contain a wanted step, up to a limit for each knot, followed by
/// the knots that need a shared wait.
pub(super) fn find(components: usize, waits: &[Wait], is_wanted: impl Fn(&Step) -> bool) -> Vec<Deadlock> {
    let single = waits.iter().filter(|wait| wait.steps.len() == 1).map(|wait| wait.steps[0]);
    let graph = Graph::new(components, single);
    let circles = graph.circles(is_wanted).into_iter();
    let mut found: Vec<Deadlock> = circles
        .map(|circle| Deadlock { steps: circle.steps, is_circle: true, has_others: circle.has_others })
        .collect();
    // Deadlocks that remain once those circles are broken depend on a shared wait.
    let knots = graph.knots();
    let in_a_circle = |wait: &Wait| wait.steps.len() == 1 && knots[wait.from()] == knots[wait.steps[0].to];
    let rest: Vec<&Wait> = waits.iter().filter(|wait| !in_a_circle(wait)).collect();
    found.extend(closed_knots(components, &rest));
    found
}

/// Returns the knot of each component, over the steps of all waits that can last without limit. A component that cannot
/// be stuck is a knot by itself.
pub(super) fn knots(components: usize, waits: &[Wait]) -> Vec<usize> {
    let waits: Vec<&Wait> = waits.iter().collect();
    let stuck = stuck(components, &waits);
    let lasting = waits.into_iter().filter(|wait| is_lasting(wait, &stuck));
    Graph::new(components, lasting.flat_map(|wait| wait.steps.iter().copied())).knots()
}

/// Returns the knots that no step leaves, which are deadlocks. One wait of each stuck component is enough to find them.
fn closed_knots(components: usize, waits: &[&Wait]) -> Vec<Deadlock> {
    let stuck = stuck(components, waits);
    let mut chosen: Vec<Option<&Wait>> = vec![None; components];
    for wait in waits.iter().filter(|wait| stuck[wait.from()] && is_lasting(wait, &stuck)) {
        chosen[wait.from()].get_or_insert(wait);
    }
    let steps: Vec<Step> = chosen.into_iter().flatten().flat_map(|wait| wait.steps.iter().copied()).collect();
    let knots = Graph::new(components, steps.iter().copied()).knots();
    let mut closed: BTreeMap<usize, Option<Vec<Step>>> = BTreeMap::new();
    for step in steps {
        let knot = closed.entry(knots[step.from]).or_insert_with(|| Some(Vec::new()));
        match knot {
            Some(inner) if knots[step.to] == knots[step.from] => inner.push(step),
            _ => *knot = None,
        }
    }
    let mut found: Vec<Vec<Step>> = closed.into_values().flatten().collect();
    found.iter_mut().for_each(|steps| steps.sort_unstable_by_key(|step| step.link));
    found.sort_unstable_by_key(|steps| steps[0].link);
    found.into_iter().map(|steps| Deadlock { steps, is_circle: false, has_others: false }).collect()
}

fn is_lasting(wait: &Wait, stuck: &[bool]) -> bool {
    wait.steps.iter().all(|step| stuck[step.to])
}

/// Returns which components can be stuck, after Kahn (1962): a component without a wait that can last is never stuck,
/// and ends the waits for it.
fn stuck(components: usize, waits: &[&Wait]) -> Vec<bool> {
    let mut lasting = vec![0_usize; components];
    let mut ended_by: Vec<Vec<usize>> = vec![Vec::new(); components];
    for (at, wait) in waits.iter().enumerate() {
        lasting[wait.from()] += 1;
        wait.steps.iter().for_each(|step| ended_by[step.to].push(at));
    }
    let mut stuck = vec![true; components];
    let mut has_ended = vec![false; waits.len()];
    let mut free: Vec<usize> = (0..components).filter(|&component| lasting[component] == 0).collect();
    while let Some(component) = free.pop() {
        stuck[component] = false;
        for &at in &ended_by[component] {
            work::add(1);
            let from = waits[at].from();
            if !std::mem::replace(&mut has_ended[at], true) {
                lasting[from] -= 1;
                free.extend((lasting[from] == 0).then_some(from));
            }
        }
    }
    stuck
}

#[cfg(test)]
mod tests {
    use super::{find, knots};
    use crate::check::circles::Step;
    use crate::check::waits::{Call, Wait};
    use std::collections::BTreeSet;

    /// The waits of each component for one other component, a bit for each pair.
    fn single(components: usize, bits: u32) -> impl Iterator<Item = Wait> {
        let pairs = (0..components).flat_map(move |from| (0..components).map(move |to| (from, to)));
        let pairs = pairs.filter(|(from, to)| from != to).enumerate().filter(move |(at, _)| bits & (1 << at) != 0);
        pairs.map(move |(_, (from, to))| wait(components, from, [to]))
    }

    /// A wait of each component for several others: for those whose bit is set, if it is more than one.
    fn shared(components: usize, bits: u32) -> impl Iterator<Item = Wait> {
        (0..components).filter_map(move |from| {
            let others = (0..components).filter(|to| bits & (1 << (from * components + to)) != 0 && *to != from);
            let others: Vec<usize> = others.collect();
            (others.len() > 1).then(|| wait(components, from, others))
        })
    }

    fn wait(components: usize, from: usize, others: impl IntoIterator<Item = usize>) -> Wait {
        let step = |to| Step { link: from * components + to, from, to };
        Wait { call: Call::Send, steps: others.into_iter().map(step).collect() }
    }

    /// Whether every component of a set waits for nobody but members of the set.
    fn is_deadlocked(set: &BTreeSet<usize>, waits: &[Wait]) -> bool {
        let within = |wait: &Wait| wait.steps.iter().all(|step| set.contains(&step.to));
        !set.is_empty() && set.iter().all(|&one| waits.iter().any(|wait| wait.from() == one && within(wait)))
    }

    /// Whether any set of components is deadlocked.
    fn has_deadlock(components: usize, waits: &[Wait]) -> bool {
        let members = |bits: usize| (0..components).filter(|at| bits & (1 << at) != 0).collect();
        (1..1_usize << components).any(|bits| is_deadlocked(&members(bits), waits))
    }

    #[test]
    fn a_deadlock_is_found_exactly_where_a_set_of_components_is_deadlocked() {
        // All waits of three components, and every seventh set of single waits of four with many sets of shared ones.
        let of_three = (0..1 << 6).flat_map(|one| (0..1 << 9).step_by(3).map(move |several| (3, one, several)));
        let of_four =
            (0..1 << 12).step_by(7).flat_map(|one| (0..1 << 16).step_by(937).map(move |several| (4, one, several)));
        let (mut with, mut without) = (0, 0);
        for (components, one, several) in of_three.chain(of_four) {
            let waits: Vec<Wait> = single(components, one).chain(shared(components, several)).collect();
            let found = find(components, &waits, |_| true);
            let expected = has_deadlock(components, &waits);
            assert_eq!(!found.is_empty(), expected, "{waits:?}");
            let knots = knots(components, &waits);
            for deadlock in &found {
                let members: BTreeSet<usize> = deadlock.steps.iter().map(|step| step.from).collect();
                assert!(is_deadlocked(&members, &waits), "{deadlock:?} of {waits:?}");
                assert!(deadlock.steps.iter().all(|step| members.contains(&step.to)), "{deadlock:?} of {waits:?}");
                assert!(deadlock.steps.iter().all(|step| knots[step.from] == knots[step.to]), "{deadlock:?}");
            }
            *(if expected { &mut with } else { &mut without }) += 1;
        }
        assert!(with > 1000 && without > 1000, "{with} with and {without} without a deadlock");
    }
}
