//! Which way edges lead if few are to lead backwards: the heuristic of Eades, Lin and Smyth (1993).

/// Returns for each node its place in an order in which few of the edges (from, to) lead backwards. If all nodes can be
/// ordered so that no edge does, none does.
pub(crate) fn order_of(nodes: usize, edges: &[(usize, usize)]) -> Vec<usize> {
    let (mut out, mut into) = (vec![0_isize; nodes], vec![0_isize; nodes]);
    let (mut after, mut before) = (vec![Vec::new(); nodes], vec![Vec::new(); nodes]);
    for &(from, to) in edges {
        out[from] += 1;
        into[to] += 1;
        after[from].push(to);
        before[to].push(from);
    }
    let (mut front, mut back) = (Vec::new(), Vec::new());
    let mut left: Vec<usize> = (0..nodes).collect();
    while !left.is_empty() {
        let sink = left.iter().rposition(|&node| out[node] == 0 && into[node] > 0);
        let source = || left.iter().position(|&node| into[node] == 0);
        let (place, is_sink) = match sink {
            Some(place) => (place, true),
            // Of several, the one that sends most and receives least; of several such, the first in the file.
            None => (source().unwrap_or_else(|| greatest(&left, |node| out[node] - into[node])), false),
        };
        let node = left.remove(place);
        if is_sink {
            back.push(node)
        } else {
            front.push(node)
        }
        after[node].iter().for_each(|&to| into[to] -= 1);
        before[node].iter().for_each(|&from| out[from] -= 1);
    }
    let mut places = vec![0; nodes];
    front.into_iter().chain(back.into_iter().rev()).enumerate().for_each(|(place, node)| places[node] = place);
    places
}

/// The place of the first node with the greatest value.
fn greatest(nodes: &[usize], value: impl Fn(usize) -> isize) -> usize {
    let best = nodes.iter().enumerate().rev().max_by_key(|&(_, &node)| value(node));
    best.map_or(0, |(place, _)| place)
}

#[cfg(test)]
mod tests {
    use super::order_of;

    #[track_caller]
    fn check(nodes: usize, edges: &[(usize, usize)], backwards: &[(usize, usize)]) {
        let places = order_of(nodes, edges);
        let found: Vec<_> = edges.iter().copied().filter(|&(from, to)| places[from] > places[to]).collect();
        assert_eq!(found, backwards);
    }

    #[test]
    fn edges_without_a_cycle_all_lead_forwards() {
        check(4, &[(3, 2), (2, 1), (1, 0), (3, 0)], &[]);
        check(3, &[], &[]);
    }

    #[test]
    fn a_cycle_has_one_edge_backwards() {
        check(3, &[(0, 1), (1, 2), (2, 0)], &[(2, 0)]);
    }

    /// Two edges lead from the sensor to the controller, one back.
    #[test]
    fn fewer_edges_lead_backwards_than_forwards() {
        check(2, &[(1, 0), (0, 1), (0, 1)], &[(1, 0)]);
    }
}
