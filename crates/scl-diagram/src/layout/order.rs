//! The order of the items in each layer, and of the rows in each block, so that few links cross: sweeps with
//! barycentres, then exchanges of neighbours.

use super::links::{Is, Layered, Port};
use super::nesting::Side;

/// Maximum number of sweeps in each direction.
const SWEEPS: usize = 16;
/// The number of sweeps without an improvement after which the rest would improve nothing either.
const PATIENCE: usize = 4;
/// Maximum number of rounds of exchanges.
const EXCHANGES: usize = 8;

/// Orders the items of all layers and the rows of all blocks.
pub(crate) fn order(layered: &mut Layered) {
    let mut order = Order::of(layered);
    let mut best = (order.crossings(), order.snapshot());
    let mut patience = PATIENCE;
    for _ in 0..SWEEPS {
        order.sweep();
        let crossings = order.crossings();
        if crossings < best.0 {
            (best, patience) = ((crossings, order.snapshot()), PATIENCE);
        } else if patience == 0 {
            break;
        }
        patience -= 1;
    }
    order.restore(best.1);
    for _ in 0..EXCHANGES {
        if !order.exchange() {
            break;
        }
    }
}

/// The order of the layers, and that of each item's ports.
type Snapshot = (Vec<Vec<usize>>, Vec<Vec<usize>>);

struct Order<'l> {
    layered: &'l mut Layered,
    /// For each item and each of its ports the ports at the other ends: to the left, and to the right.
    left: Vec<Vec<Vec<Port>>>,
    right: Vec<Vec<Vec<Port>>>,
    /// For each item the number of ports above it in its layer.
    above: Vec<usize>,
}

impl<'l> Order<'l> {
    fn of(layered: &'l mut Layered) -> Self {
        let none: Vec<Vec<Vec<Port>>> = layered.items.iter().map(|it| vec![Vec::new(); it.order.len()]).collect();
        let (mut left, mut right) = (none.clone(), none);
        for segment in &layered.segments {
            right[segment.left.item][segment.left.port].push(segment.right);
            left[segment.right.item][segment.right.port].push(segment.left);
        }
        let mut order = Self { above: vec![0; layered.items.len()], layered, left, right };
        order.group_rows();
        (0..order.layered.layers.len()).for_each(|layer| order.count(layer));
        order
    }

    /// Rows with links to the left come first, then those with links to the right, then the others.
    fn group_rows(&mut self) {
        let (left, right) = (&self.left, &self.right);
        for (index, item) in self.layered.items.iter_mut().enumerate() {
            if item.is == Is::Block {
                item.order.sort_by_key(|&row| match (left[index][row].len(), right[index][row].len()) {
                    (0, 0) => 2,
                    (0, _) => 1,
                    _ => 0,
                });
            }
        }
    }

    /// Counts the ports above each item of a layer.
    fn count(&mut self, layer: usize) {
        let mut above = 0;
        for &item in &self.layered.layers[layer] {
            self.above[item] = above;
            above += self.layered.items[item].order.len();
        }
    }

    fn position(&self, port: Port) -> usize {
        self.above[port.item] + self.layered.items[port.item].rank(port.port)
    }

    fn neighbours(&self, side: Side) -> &[Vec<Vec<Port>>] {
        match side {
            Side::Left => &self.left,
            Side::Right => &self.right,
        }
    }

    /// The mean position of the ports at the other ends; `None` if there are none.
    fn mean(&self, ports: impl Iterator<Item = Port>) -> Option<f64> {
        let (mut sum, mut count) = (0, 0);
        for port in ports {
            sum += self.position(port);
            count += 1;
        }
        (count > 0).then(|| sum as f64 / f64::from(count))
    }

    /// Orders each layer by the one to its left, then each by the one to its right.
    fn sweep(&mut self) {
        let layers = self.layered.layers.len();
        (1..layers).for_each(|layer| self.order_layer(layer, Side::Left));
        (0..layers.saturating_sub(1)).rev().for_each(|layer| self.order_layer(layer, Side::Right));
    }

    fn order_layer(&mut self, layer: usize, by: Side) {
        let mut items = std::mem::take(&mut self.layered.layers[layer]);
        for &item in &items {
            self.order_rows(item, by);
        }
        reorder(&mut items, |&item| self.mean(self.neighbours(by)[item].iter().flatten().copied()));
        self.layered.layers[layer] = items;
        self.count(layer);
    }

    /// Orders those rows of a block that have links on this side, among each other.
    fn order_rows(&mut self, item: usize, by: Side) {
        if self.layered.items[item].is != Is::Block {
            return;
        }
        let mut rows = self.layered.items[item].order.clone();
        let faces = |row: usize| by == Side::Left || self.left[item][row].is_empty();
        reorder(&mut rows, |&row| self.mean(self.neighbours(by)[item][row].iter().copied()).filter(|_| faces(row)));
        self.layered.items[item].order = rows;
    }

    /// Exchanges neighbours in all layers where that leaves fewer crossings. Returns whether it did.
    fn exchange(&mut self) -> bool {
        let mut any = false;
        for layer in 0..self.layered.layers.len() {
            for upper in 0..self.layered.layers[layer].len().saturating_sub(1) {
                let (one, other) = (self.layered.layers[layer][upper], self.layered.layers[layer][upper + 1]);
                let (now, then) = (self.between(one, other), self.between(other, one));
                if then < now {
                    self.layered.layers[layer].swap(upper, upper + 1);
                    any = true;
                    self.count(layer);
                }
            }
        }
        any
    }

    /// The crossings of the links of two items if one is directly above the other.
    fn between(&self, upper: usize, lower: usize) -> usize {
        let sides = [Side::Left, Side::Right].map(|side| {
            let positions = |item: usize| {
                let ports = self.neighbours(side)[item].iter().flatten();
                let mut positions: Vec<usize> = ports.map(|&port| self.position(port)).collect();
                positions.sort_unstable();
                positions
            };
            let (upper, lower) = (positions(upper), positions(lower));
            upper.iter().map(|&it| lower.partition_point(|&other| other < it)).sum::<usize>()
        });
        sides.iter().sum()
    }

    /// All crossings between neighbouring layers.
    fn crossings(&self) -> usize {
        let mut links = vec![Vec::new(); self.layered.layers.len()];
        for segment in &self.layered.segments {
            let layer = self.layered.items[segment.left.item].layer;
            links[layer].push((self.position(segment.left), self.position(segment.right)));
        }
        links.into_iter().map(inversions).sum()
    }

    fn snapshot(&self) -> Snapshot {
        (self.layered.layers.clone(), self.layered.items.iter().map(|item| item.order.clone()).collect())
    }

    fn restore(&mut self, (layers, orders): Snapshot) {
        self.layered.layers = layers;
        self.layered.items.iter_mut().zip(orders).for_each(|(item, order)| item.order = order);
        (0..self.layered.layers.len()).for_each(|layer| self.count(layer));
    }
}

/// Orders those that have a key, among each other; the others keep their places.
fn reorder(items: &mut [usize], key: impl Fn(&usize) -> Option<f64>) {
    let keyed = items.iter().enumerate().filter_map(|(place, item)| Some((place, *item, key(item)?)));
    let mut keyed: Vec<(usize, usize, f64)> = keyed.collect();
    let places: Vec<usize> = keyed.iter().map(|&(place, ..)| place).collect();
    keyed.sort_by(|(.., one), (.., other)| one.total_cmp(other));
    for (place, (_, item, _)) in places.into_iter().zip(keyed) {
        items[place] = item;
    }
}

/// The number of pairs of links of which one starts above and ends below the other, after Barth, Jünger and Mutzel
/// (2002).
fn inversions(mut links: Vec<(usize, usize)>) -> usize {
    links.sort_unstable();
    let size = links.iter().map(|&(_, right)| right + 1).max().unwrap_or(0);
    // A Fenwick tree of the links so far by their right ends.
    let mut tree = vec![0_usize; size + 1];
    let mut crossings = 0;
    let mut done = 0;
    for upper in 0..links.len() {
        // Links with the same left end do not cross.
        while links[done].0 < links[upper].0 {
            let mut at = links[done].1 + 1;
            while at <= size {
                tree[at] += 1;
                at += at & at.wrapping_neg();
            }
            done += 1;
        }
        let mut at = links[upper].1 + 1;
        let mut not_below = 0;
        while at > 0 {
            not_below += tree[at];
            at -= at & at.wrapping_neg();
        }
        crossings += done - not_below;
    }
    crossings
}

#[cfg(test)]
mod tests {
    use super::inversions;

    #[test]
    fn links_cross_if_their_ends_are_in_opposite_order() {
        assert_eq!(inversions(vec![]), 0);
        assert_eq!(inversions(vec![(0, 0), (1, 1)]), 0);
        assert_eq!(inversions(vec![(0, 1), (1, 0)]), 1);
        assert_eq!(inversions(vec![(0, 2), (1, 1), (2, 0)]), 3);
    }

    #[test]
    fn links_with_a_common_end_do_not_cross() {
        assert_eq!(inversions(vec![(0, 0), (0, 1), (0, 2)]), 0);
        assert_eq!(inversions(vec![(0, 1), (1, 1), (2, 1)]), 0);
        assert_eq!(inversions(vec![(0, 2), (0, 1), (1, 1)]), 1);
    }
}
