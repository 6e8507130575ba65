//! The layer of each node: later than those of all nodes before it, and no earlier than necessary for what comes after.

/// Assigns layers, starting with 0, to nodes of which the edges (earlier, later) form no cycle.
pub(crate) fn layers_of(nodes: usize, edges: &[(usize, usize)]) -> Vec<usize> {
    let (mut after, mut before) = (vec![Vec::new(); nodes], vec![Vec::new(); nodes]);
    for &(earlier, later) in edges {
        after[earlier].push(later);
        before[later].push(earlier);
    }
    let sorted = sorted(&after, &before);
    let mut layers = vec![0; nodes];
    for &node in &sorted {
        layers[node] = before[node].iter().map(|&it| layers[it] + 1).max().unwrap_or(0);
    }
    // The longest path puts all sources into the first layer. Nodes with more edges to later nodes than to earlier ones
    // move towards the later ones, which makes more edges shorter than longer.
    for &node in sorted.iter().rev() {
        if after[node].len() > before[node].len() {
            let next = after[node].iter().map(|&it| layers[it]).min();
            layers[node] = next.map_or(layers[node], |next| next - 1);
        }
    }
    let first = layers.iter().copied().min().unwrap_or(0);
    layers.iter_mut().for_each(|layer| *layer -= first);
    layers
}

/// The nodes in an order in which each comes after those before it.
fn sorted(after: &[Vec<usize>], before: &[Vec<usize>]) -> Vec<usize> {
    let mut missing: Vec<usize> = before.iter().map(Vec::len).collect();
    let mut sorted: Vec<usize> = (0..after.len()).filter(|&node| missing[node] == 0).collect();
    let mut done = 0;
    while let Some(&node) = sorted.get(done) {
        done += 1;
        for &later in &after[node] {
            missing[later] -= 1;
            if missing[later] == 0 {
                sorted.push(later);
            }
        }
    }
    assert_eq!(sorted.len(), after.len(), "the edges between blocks form a cycle");
    sorted
}

#[cfg(test)]
mod tests {
    use super::layers_of;

    #[test]
    fn each_node_is_in_a_later_layer_than_those_before_it() {
        assert_eq!(layers_of(4, &[(0, 1), (1, 2), (0, 2), (2, 3)]), [0, 1, 2, 3]);
        assert!(layers_of(0, &[]).is_empty());
    }

    #[test]
    fn a_source_is_directly_before_the_node_that_needs_it() {
        assert_eq!(layers_of(5, &[(0, 1), (1, 2), (2, 3), (4, 3)]), [0, 1, 2, 3, 2]);
    }
}
