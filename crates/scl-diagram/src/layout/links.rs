//! One level in layers: items with ports, and links that lead from the right side of an item to the left side of one in
//! a later layer. A link that passes through a layer has an item of its own there, which links with the same left port
//! share.

use std::collections::{BTreeMap, HashSet};

/// What stands in a layer.
#[derive(Debug, Clone)]
pub(crate) struct Item {
    pub(crate) layer: usize,
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// The distances of its ports from its upper edge, from top to bottom.
    pub(crate) offsets: Vec<f64>,
    /// Which port is at each of these distances.
    pub(crate) order: Vec<usize>,
    pub(crate) is: Is,
}

/// What an item is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Is {
    /// A block, the order of whose ports can be chosen.
    Block,
    /// A frame, whose ports are where its content has them.
    Frame,
    /// A point that edges pass.
    Passage,
}

impl Item {
    /// A point that edges pass.
    pub(crate) fn passage(layer: usize) -> Self {
        Self { layer, width: 0.0, height: 0.0, offsets: vec![0.0], order: vec![0], is: Is::Passage }
    }

    /// The number of ports above a port.
    pub(crate) fn rank(&self, port: usize) -> usize {
        self.order.iter().take_while(|&&above| above != port).count()
    }

    /// The distance of a port from the item's upper edge.
    pub(crate) fn offset(&self, port: usize) -> f64 {
        self.offsets[self.rank(port)]
    }
}

/// A port of an item.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Port {
    pub(crate) item: usize,
    pub(crate) port: usize,
}

/// A link between two neighbouring layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) struct Segment {
    pub(crate) left: Port,
    pub(crate) right: Port,
}

/// The items, the layers that they are in, and the links.
#[derive(Debug, Clone, Default)]
pub(crate) struct Layered {
    pub(crate) items: Vec<Item>,
    /// The items of each layer from top to bottom.
    pub(crate) layers: Vec<Vec<usize>>,
    /// The segments of all links, each once.
    pub(crate) segments: Vec<Segment>,
    /// The passages of each link in the layers between those of its ends.
    passages: BTreeMap<(Port, Port), Vec<usize>>,
}

impl Layered {
    /// Puts items into layers and connects them by links (left port, right port).
    pub(crate) fn of(items: Vec<Item>, links: &[(Port, Port)]) -> Self {
        let layers = items.iter().map(|item| item.layer + 1).max().unwrap_or(0);
        let mut layered = Self { items, layers: vec![Vec::new(); layers], ..Self::default() };
        let (mut shared, mut known) = (BTreeMap::new(), HashSet::new());
        for &(left, right) in links {
            let (first, last) = (layered.items[left.item].layer, layered.items[right.item].layer);
            assert!(first < last, "an edge leads from a layer to a later one");
            let (mut passages, mut at) = (Vec::new(), left);
            for layer in first + 1..last {
                let item = *shared.entry((left, layer)).or_insert_with(|| {
                    layered.items.push(Item::passage(layer));
                    layered.items.len() - 1
                });
                passages.push(item);
                let next = Port { item, port: 0 };
                layered.connect(&mut known, at, next);
                at = next;
            }
            layered.connect(&mut known, at, right);
            layered.passages.insert((left, right), passages);
        }
        for (index, item) in layered.items.iter().enumerate() {
            layered.layers[item.layer].push(index);
        }
        layered
    }

    fn connect(&mut self, known: &mut HashSet<Segment>, left: Port, right: Port) {
        let segment = Segment { left, right };
        if known.insert(segment) {
            self.segments.push(segment);
        }
    }

    /// The passages of a link, from left to right.
    pub(crate) fn passages(&self, left: Port, right: Port) -> &[usize] {
        self.passages.get(&(left, right)).map_or(&[], Vec::as_slice)
    }
}
