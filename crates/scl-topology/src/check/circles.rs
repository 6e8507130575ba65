//! Circles in a graph of components, for the rules about the graph as a whole. Takes linear time.

use super::draft::Draft;
use crate::source::Span;
use crate::work;
use std::collections::{HashMap, HashSet, VecDeque};

/// How many circles of one knot are reported. Most knots have one; in a larger one, the first few show what is wrong,
/// and breaking them breaks many others.
const MOST_OF_A_KNOT: usize = 3;

/// Maximum number of components that a headline names.
const MOST_NAMES: usize = 8;

/// One step from a component to another, with the connection that makes it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct Step {
    pub(super) link: usize,
    pub(super) from: usize,
    pub(super) to: usize,
}

/// A circle: each step begins where the one before ends. It starts with the connection that stands first in the file.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Circle {
    pub(super) steps: Vec<Step>,
    /// Whether more circles run through the same components than are reported.
    pub(super) has_others: bool,
}

/// Components and the steps between them.
pub(super) struct Graph {
    /// The steps that leave each component, in file order.
    steps: Vec<Vec<Step>>,
}

impl Graph {
    pub(super) fn new(components: usize, steps: impl IntoIterator<Item = Step>) -> Self {
        let mut graph = Self { steps: vec![Vec::new(); components] };
        for step in steps.into_iter().filter(|step| step.from != step.to) {
            graph.steps[step.from].push(step);
        }
        graph
    }

    /// Returns the shortest circles that together contain every wanted step of each knot, but at most
    /// [`MOST_OF_A_KNOT`] for a knot.
    pub(super) fn circles(&self, is_wanted: impl Fn(&Step) -> bool) -> Vec<Circle> {
        let knots = self.knots();
        let mut inner: HashMap<usize, Vec<Step>> = HashMap::new();
        for step in self.steps.iter().flatten().filter(|step| knots[step.from] == knots[step.to] && is_wanted(step)) {
            inner.entry(knots[step.from]).or_default().push(*step);
        }
        let mut circles: Vec<Circle> = inner.into_values().flat_map(|steps| self.circles_in(steps, &knots)).collect();
        circles.sort_unstable_by_key(|circle| circle.steps[0].link);
        circles
    }

    fn circles_in(&self, mut steps: Vec<Step>, knots: &[usize]) -> Vec<Circle> {
        steps.sort_unstable_by_key(|step| step.link);
        let mut covered = HashSet::new();
        let mut circles: Vec<Circle> = Vec::new();
        for step in steps {
            if covered.contains(&step) {
                continue;
            }
            if circles.len() == MOST_OF_A_KNOT {
                circles.iter_mut().for_each(|circle| circle.has_others = true);
                break;
            }
            if let Some(steps) = self.circle_through(step, knots, &covered) {
                covered.extend(steps.iter().copied());
                circles.push(Circle { steps: from_the_first(steps), has_others: false });
            }
        }
        circles
    }

    /// Finds a shortest circle through `first`, breadth first. Prefers steps that are in no circle yet.
    fn circle_through(&self, first: Step, knots: &[usize], covered: &HashSet<Step>) -> Option<Vec<Step>> {
        let mut arrived: HashMap<usize, Step> = HashMap::from([(first.to, first)]);
        let mut waiting = VecDeque::from([first.to]);
        while let Some(at) = waiting.pop_front() {
            work::add(1 + self.steps[at].len());
            let inner = || self.steps[at].iter().filter(|step| knots[step.to] == knots[first.to]);
            let new = inner().filter(|step| !covered.contains(step));
            let old = inner().filter(|step| covered.contains(step));
            for step in new.chain(old) {
                if step.to == first.from {
                    return Some(way_to(*step, first, &arrived));
                }
                arrived.entry(step.to).or_insert_with(|| {
                    waiting.push_back(step.to);
                    *step
                });
            }
        }
        None
    }

    /// Returns the knot of each component: all members of a knot reach each other. After Tarjan (1972), with an
    /// explicit stack, because a file may be one long chain.
    pub(super) fn knots(&self) -> Vec<usize> {
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
                work::add(1);
                if step == 0 {
                    (order[at], low[at]) = (next, next);
                    next += 1;
                    open.push(at);
                } else {
                    let child = self.steps[at][step - 1].to;
                    // A closed knot (a finished strongly connected component) cannot reach `at`.
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

/// The connection that makes a step, as it is written.
pub(super) fn place(draft: &Draft<'_>, step: &Step) -> Span {
    draft.links[step.link].model.span
}

/// The components of a circle, for a headline: `` `a` -> `b` -> `a` ``.
pub(super) fn round(draft: &Draft<'_>, steps: &[Step]) -> String {
    let name = |step: &Step| format!("`{}`", draft.components[step.from].model.name.value);
    let mut names: Vec<String> = steps.iter().take(MOST_NAMES).map(name).collect();
    if steps.len() > MOST_NAMES {
        names.push(format!("{} more", steps.len() - MOST_NAMES));
    }
    names.push(name(&steps[0]));
    names.join(" -> ")
}

/// Pops a whole knot from the stack. `root`, its first component, becomes its name.
fn close(root: usize, open: &mut Vec<usize>, knot: &mut [usize]) {
    while let Some(member) = open.pop() {
        knot[member] = root;
        if member == root {
            return;
        }
    }
}

/// The steps from `first` to `last`, both included.
fn way_to(last: Step, first: Step, arrived: &HashMap<usize, Step>) -> Vec<Step> {
    let mut way = vec![last];
    while let Some(&step) = way.last()
        && step != first
        && let Some(before) = arrived.get(&step.from)
    {
        way.push(*before);
    }
    way.reverse();
    way
}

fn from_the_first(mut steps: Vec<Step>) -> Vec<Step> {
    let first = steps.iter().enumerate().min_by_key(|(_, step)| step.link).map_or(0, |(at, _)| at);
    steps.rotate_left(first);
    steps
}

#[cfg(test)]
mod tests {
    use super::{Circle, Graph, Step};

    fn graph(count: usize, pairs: &[(usize, usize)]) -> Graph {
        Graph::new(count, pairs.iter().enumerate().map(|(link, &(from, to))| Step { link, from, to }))
    }

    fn circles(count: usize, pairs: &[(usize, usize)]) -> Vec<Vec<usize>> {
        let names = |circle: &Circle| circle.steps.iter().map(|step| step.from).collect();
        graph(count, pairs).circles(|_| true).iter().map(names).collect()
    }

    #[test]
    fn every_step_of_a_knot_is_in_a_circle() {
        assert_eq!(circles(4, &[(0, 1), (1, 2), (2, 3), (0, 3)]), [[0; 0]; 0]);
        assert_eq!(circles(3, &[(0, 1), (1, 2), (2, 0)]), [[0, 1, 2]]);
        assert_eq!(circles(3, &[(2, 0), (0, 1), (1, 2)]), [[2, 0, 1]]);
        assert_eq!(circles(4, &[(0, 1), (1, 2), (2, 3), (3, 0), (2, 1)]), [vec![0, 1, 2, 3], vec![1, 2]]);
        assert_eq!(circles(3, &[(0, 1), (1, 0), (1, 2), (2, 0)]), [vec![0, 1], vec![0, 1, 2]]);
        assert_eq!(circles(5, &[(0, 1), (1, 0), (1, 2), (2, 3), (3, 2), (4, 0)]), [[0, 1], [2, 3]]);
    }

    #[test]
    fn two_circles_of_one_pair_share_no_step() {
        let found = graph(2, &[(0, 1), (1, 0), (0, 1), (1, 0)]).circles(|_| true);
        let links: Vec<Vec<usize>> =
            found.iter().map(|circle| circle.steps.iter().map(|step| step.link).collect()).collect();
        assert_eq!(links, [[0, 1], [2, 3]]);
    }

    #[test]
    fn few_circles_of_a_knot_are_reported() {
        let star: Vec<(usize, usize)> = (1..6).flat_map(|at| [(0, at), (at, 0)]).collect();
        let found = graph(6, &star).circles(|_| true);
        assert_eq!(found.len(), super::MOST_OF_A_KNOT);
        assert!(found.iter().all(|circle| circle.has_others));
        let found = graph(4, &star[..6]).circles(|_| true);
        assert!(found.len() == 3 && found.iter().all(|circle| !circle.has_others));
    }

    #[test]
    fn a_long_chain_needs_no_deep_stack() {
        let mut pairs: Vec<(usize, usize)> = (0..50_000).map(|at| (at, at + 1)).collect();
        assert!(circles(50_001, &pairs).is_empty());
        pairs.push((50_000, 0));
        assert_eq!(circles(50_001, &pairs)[0].len(), 50_001);
    }
}
