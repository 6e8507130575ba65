//! Which components reach which others, for the rules about the graph as a whole. Takes linear time, but for the
//! search of the shortest circle, whose effort has a limit.

use super::draft::Draft;
use crate::topology::GateKind;
use std::collections::{HashMap, VecDeque};

/// From how many components of one knot a shortest circle is searched. Knots are small, and a circle through one of the
/// first components is as good a hint as any.
const MOST_STARTS: usize = 32;

/// One step from a component to the next, with the connection that makes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    pub(super) link: usize,
    pub(super) from: usize,
    pub(super) to: usize,
}

/// The connections of one kind between components; those of a component with itself have rules of their own.
pub(super) struct ComponentGraph {
    steps: Vec<Vec<Step>>,
}

impl ComponentGraph {
    /// The connections whose source is of this kind, each pair of components once.
    pub(super) fn of(draft: &Draft<'_>, kind: GateKind) -> Self {
        let mut steps: Vec<Vec<Step>> = vec![Vec::new(); draft.components.len()];
        let mut seen = HashMap::new();
        for (link, source, sink) in draft.flows().filter(|&(_, source, _)| draft.gates[source].kind == Some(kind)) {
            let (from, to) = (draft.gates[source].component, draft.gates[sink].component);
            let is_first = *seen.entry((from, to)).or_insert(link) == link;
            if is_first && draft.component_name(source) != draft.component_name(sink) {
                steps[from].push(Step { link, from, to });
            }
        }
        Self { steps }
    }

    /// A shortest circle of each knot, a set of components that all reach each other. Each circle starts with the
    /// connection that stands first in the file.
    pub(super) fn circles(&self) -> Vec<Vec<Step>> {
        let knot_of = self.knots();
        let mut knots: HashMap<usize, Vec<usize>> = HashMap::new();
        for (component, knot) in knot_of.iter().enumerate() {
            knots.entry(*knot).or_default().push(component);
        }
        let mut knots: Vec<Vec<usize>> = knots.into_values().filter(|members| members.len() > 1).collect();
        knots.sort_unstable();
        knots.iter().filter_map(|members| self.circle_in(members, &knot_of)).collect()
    }

    fn circle_in(&self, members: &[usize], knot_of: &[usize]) -> Option<Vec<Step>> {
        let starts = members.iter().take(MOST_STARTS);
        let mut circle = starts.filter_map(|&start| self.circle_through(start, knot_of)).min_by_key(Vec::len)?;
        let first = circle.iter().enumerate().min_by_key(|(_, step)| step.link).map_or(0, |(at, _)| at);
        circle.rotate_left(first);
        Some(circle)
    }

    /// Breadth first, so that the first way back is the shortest.
    fn circle_through(&self, start: usize, knot_of: &[usize]) -> Option<Vec<Step>> {
        let mut arrived: HashMap<usize, Step> = HashMap::new();
        let mut waiting = VecDeque::from([start]);
        while let Some(at) = waiting.pop_front() {
            for step in self.steps[at].iter().filter(|step| knot_of[step.to] == knot_of[start]) {
                if step.to == start {
                    return Some(way_back(*step, start, &arrived));
                }
                arrived.entry(step.to).or_insert_with(|| {
                    waiting.push_back(step.to);
                    *step
                });
            }
        }
        None
    }

    /// The knot of each component, after Tarjan (1972), on a stack of its own: a file may be one long chain.
    fn knots(&self) -> Vec<usize> {
        const NEW: usize = usize::MAX;
        let count = self.steps.len();
        let (mut order, mut low, mut knot) = (vec![NEW; count], vec![NEW; count], vec![NEW; count]);
        let (mut open, mut path): (Vec<usize>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
        let mut next = 0;
        for root in 0..count {
            if order[root] == NEW {
                path.push((root, 0));
            }
            while let Some((at, step)) = path.pop() {
                if step == 0 {
                    (order[at], low[at]) = (next, next);
                    next += 1;
                    open.push(at);
                } else {
                    let child = self.steps[at][step - 1].to;
                    // There is no way back from a knot that is closed.
                    if knot[child] == NEW {
                        low[at] = low[at].min(low[child]);
                    }
                }
                match self.steps[at].get(step).map(|step| step.to) {
                    Some(to) => {
                        path.push((at, step + 1));
                        if order[to] == NEW {
                            path.push((to, 0));
                        }
                    }
                    None if low[at] == order[at] => close(at, &mut open, &mut knot),
                    None => {}
                }
            }
        }
        knot
    }
}

/// Takes a whole knot from the stack; it is named by its first component.
fn close(root: usize, open: &mut Vec<usize>, knot: &mut [usize]) {
    while let Some(member) = open.pop() {
        knot[member] = root;
        if member == root {
            return;
        }
    }
}

fn way_back(last: Step, start: usize, arrived: &HashMap<usize, Step>) -> Vec<Step> {
    let mut way = vec![last];
    let mut at = last.from;
    while at != start
        && let Some(step) = arrived.get(&at)
    {
        way.push(*step);
        at = step.from;
    }
    way.reverse();
    way
}

#[cfg(test)]
mod tests {
    use super::{ComponentGraph, Step};

    fn circles(count: usize, pairs: &[(usize, usize)]) -> Vec<Vec<usize>> {
        let mut steps = vec![Vec::new(); count];
        for (link, &(from, to)) in pairs.iter().enumerate() {
            steps[from].push(Step { link, from, to });
        }
        let found = ComponentGraph { steps }.circles();
        found.iter().map(|circle| circle.iter().map(|step| step.from).collect()).collect()
    }

    #[test]
    fn each_knot_has_one_shortest_circle() {
        assert_eq!(circles(4, &[(0, 1), (1, 2), (2, 3), (0, 3)]), [[0; 0]; 0]);
        assert_eq!(circles(3, &[(0, 1), (1, 2), (2, 0)]), [[0, 1, 2]]);
        assert_eq!(circles(3, &[(2, 0), (0, 1), (1, 2)]), [[2, 0, 1]]);
        assert_eq!(circles(4, &[(0, 1), (1, 2), (2, 3), (3, 0), (2, 1)]), [[1, 2]]);
        assert_eq!(circles(5, &[(0, 1), (1, 0), (1, 2), (2, 3), (3, 2), (4, 0)]), [[0, 1], [2, 3]]);
    }

    #[test]
    fn a_long_chain_needs_no_deep_stack() {
        let mut pairs: Vec<(usize, usize)> = (0..50_000).map(|at| (at, at + 1)).collect();
        assert!(circles(50_001, &pairs).is_empty());
        pairs.push((50_000, 0));
        assert_eq!(circles(50_001, &pairs)[0].len(), 50_001);
    }
}
