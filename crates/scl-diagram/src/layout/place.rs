//! Coordinates: each item as close as possible to the ports that it is linked with, in the order of its layer and
//! without overlaps.

use super::links::{Is, Item, Layered, Port};
use super::metrics::{BETWEEN_BLOCKS, BETWEEN_EDGES, NARROWEST_GAP, WIDEST_GAP};
use super::nesting::Side;

/// The number of sweeps in each direction.
const SWEEPS: usize = 10;
/// How much an item without links on one side holds to its place.
const IDLE_WEIGHT: f64 = 0.01;

/// Where the items are.
pub(crate) struct Places {
    /// The upper edge of each item.
    pub(crate) y: Vec<f64>,
    /// The left edge and the width of each layer.
    pub(crate) layers: Vec<(f64, f64)>,
    pub(crate) width: f64,
    pub(crate) height: f64,
}

impl Places {
    pub(crate) fn of(layered: &Layered) -> Self {
        let y = vertical(layered);
        let bottom = |(item, y): (&Item, &f64)| item.height + y;
        let height = layered.items.iter().zip(&y).map(bottom).fold(0.0, f64::max);
        let mut layers = Vec::new();
        let mut x = 0.0;
        for (index, items) in layered.layers.iter().enumerate() {
            let width = items.iter().map(|&item| layered.items[item].width).fold(0.0, f64::max);
            layers.push((x, width));
            x += width + gap_after(layered, &y, index);
        }
        let width = layers.last().map_or(0.0, |(x, width)| x + width);
        Self { y, layers, width, height }
    }

    /// The height at which a port is.
    pub(crate) fn of_port(&self, layered: &Layered, port: Port) -> f64 {
        height_of(layered, &self.y, port)
    }
}

/// The height of a port, given the upper edges of the items.
fn height_of(layered: &Layered, y: &[f64], port: Port) -> f64 {
    y[port.item] + layered.items[port.item].offset(port.port)
}

/// The space between a layer and the next: wider if links go far up or down.
fn gap_after(layered: &Layered, y: &[f64], layer: usize) -> f64 {
    let links = layered.segments.iter().filter(|it| layered.items[it.left.item].layer == layer);
    let rise = links.map(|it| (height_of(layered, y, it.right) - height_of(layered, y, it.left)).abs());
    (rise.fold(0.0, f64::max) * 0.25).clamp(NARROWEST_GAP, WIDEST_GAP).round()
}

/// The upper edges of all items.
fn vertical(layered: &Layered) -> Vec<f64> {
    let mut y = vec![0.0; layered.items.len()];
    for layer in &layered.layers {
        let mut next = 0.0;
        for (place, &item) in layer.iter().enumerate() {
            let before = place.checked_sub(1).map(|before| &layered.items[layer[before]]);
            next += before.map_or(0.0, |before| between(before, &layered.items[item]));
            y[item] = next;
            next += layered.items[item].height;
        }
    }
    let (mut left, mut right) = (vec![Vec::new(); layered.items.len()], vec![Vec::new(); layered.items.len()]);
    for segment in &layered.segments {
        left[segment.right.item].push(*segment);
        right[segment.left.item].push(*segment);
    }
    let wanted = |y: &[f64], item: usize, side: Side| {
        let (links, idle) = (if side == Side::Left { &left[item] } else { &right[item] }, (y[item], IDLE_WEIGHT));
        let (mut sum, mut weights) = (0.0, 0.0);
        for link in links {
            let (own, other) = if side == Side::Left { (link.right, link.left) } else { (link.left, link.right) };
            let weight = weight(&layered.items[own.item], &layered.items[other.item]);
            sum += weight * (height_of(layered, y, other) - layered.items[own.item].offset(own.port));
            weights += weight;
        }
        if links.is_empty() { idle } else { (sum / weights, weights) }
    };
    let layers = layered.layers.len();
    for _ in 0..SWEEPS {
        for layer in 1..layers {
            place_layer(layered, layer, &mut y, |y, item| wanted(y, item, Side::Left));
        }
        for layer in (0..layers.saturating_sub(1)).rev() {
            place_layer(layered, layer, &mut y, |y, item| wanted(y, item, Side::Right));
        }
    }
    let top = y.iter().copied().fold(f64::INFINITY, f64::min);
    y.iter().map(|it| (it - top).round()).collect()
}

/// Links between passages are straight rather than others, because they are the longest.
fn weight(one: &Item, other: &Item) -> f64 {
    match (one.is, other.is) {
        (Is::Passage, Is::Passage) => 8.0,
        (Is::Passage, _) | (_, Is::Passage) => 2.0,
        _ => 1.0,
    }
}

/// The least space between two items, one above the other.
fn between(upper: &Item, lower: &Item) -> f64 {
    match (upper.is, lower.is) {
        (Is::Passage, Is::Passage) => BETWEEN_EDGES,
        (Is::Passage, _) | (_, Is::Passage) => (BETWEEN_EDGES + BETWEEN_BLOCKS) / 2.0,
        _ => BETWEEN_BLOCKS,
    }
}

/// Puts the items of a layer where they want to be, as the method of least squares has it if none may overlap:
/// neighbours that would overlap become one that wants to be at the mean of their places.
fn place_layer(layered: &Layered, layer: usize, y: &mut [f64], wanted: impl Fn(&[f64], usize) -> (f64, f64)) {
    /// Neighbours that touch: where the first one's upper edge would be without those before it, and how strongly.
    struct Run {
        place: f64,
        weight: f64,
        items: usize,
    }
    let (mut runs, mut starts, mut before): (Vec<Run>, Vec<f64>, f64) = (Vec::new(), Vec::new(), 0.0);
    let items = &layered.layers[layer];
    for (index, &item) in items.iter().enumerate() {
        if let Some(previous) = index.checked_sub(1).map(|index| &layered.items[items[index]]) {
            before += previous.height + between(previous, &layered.items[item]);
        }
        starts.push(before);
        let (place, weight) = wanted(y, item);
        let mut run = Run { place: place - before, weight, items: 1 };
        while let Some(upper) = runs.pop_if(|upper| upper.place > run.place) {
            let weight = upper.weight + run.weight;
            let place = (upper.place * upper.weight + run.place * run.weight) / weight;
            run = Run { place, weight, items: upper.items + run.items };
        }
        runs.push(run);
    }
    let places = runs.iter().flat_map(|run| std::iter::repeat_n(run.place, run.items));
    for ((&item, start), place) in items.iter().zip(starts).zip(places) {
        y[item] = place + start;
    }
}
