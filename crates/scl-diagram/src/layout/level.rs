//! The content of one frame: its blocks and inner frames in layers, and beside them the points at which edges leave it.

use super::links::{Is, Item, Layered, Port};
use super::metrics::{ABOVE_FRAME, BELOW_FRAME, BESIDE_FRAME, BETWEEN_BLOCKS, ends_of, height_of, width_of};
use super::nesting::{Nesting, Part, Side};
use super::place::Places;
use super::{Point, cycles, layers, order};
use crate::diagram::End;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// An end within a frame from which edges lead out of the frame, and the side of the frame where they do.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Inside {
    pub(crate) end: End,
    pub(crate) side: Side,
}

/// The content of a frame with its places, from its upper left corner.
#[derive(Default)]
pub(crate) struct Level {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) members: Vec<PlacedMember>,
    /// The edges between two members.
    pub(crate) edges: BTreeMap<usize, Between>,
    /// The points, from left to right, of what leads from an end to the border, or from the border to an end.
    pub(crate) leaving: BTreeMap<Inside, Vec<Point>>,
    /// Where edges cross the border: the ends that they come from, from top to bottom.
    ports: Vec<(Inside, f64)>,
}

/// The part of an edge between two members of a level.
#[derive(Clone)]
pub(crate) struct Between {
    /// The frame of the level.
    pub(crate) frame: Option<usize>,
    /// Whether the edge starts at its left end.
    pub(crate) forwards: bool,
    /// Its points from left to right.
    pub(crate) points: Vec<Point>,
}

pub(crate) struct PlacedMember {
    pub(crate) member: Member,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) width: f64,
    pub(crate) height: f64,
    /// The rows of a block from top to bottom.
    pub(crate) rows: Vec<usize>,
}

/// A block, or a frame with its content.
pub(crate) enum Member {
    Block(usize),
    Frame(usize, Level),
}

impl Level {
    /// Lays out a frame, given the ends in it from which edges leave it.
    pub(crate) fn of(nesting: &Nesting<'_>, frame: Option<usize>, leaving: &[Inside]) -> Self {
        let parts = nesting.parts(frame);
        let part_of: HashMap<Part, usize> = parts.iter().enumerate().map(|(index, &part)| (part, index)).collect();
        let part_with = |end: End| part_of[&nesting.part_with(frame, end)];
        let edges = directed(nesting, frame, parts.len(), &part_with);
        let layers = layers_with_borders(parts.len(), &edges, leaving, &part_with);

        // Each inner frame learns which edges leave it where.
        let mut inner: Vec<BTreeSet<Inside>> = vec![BTreeSet::new(); parts.len()];
        for edge in &edges {
            inner[edge.left_part].insert(Inside { end: edge.left, side: Side::Right });
            inner[edge.right_part].insert(Inside { end: edge.right, side: Side::Left });
        }
        leaving.iter().for_each(|&inside| _ = inner[part_with(inside.end)].insert(inside));
        let content = |(part, leaving): (&Part, &BTreeSet<Inside>)| match *part {
            Part::Block(_) => Level::default(),
            Part::Frame(frame) => Level::of(nesting, Some(frame), &leaving.iter().copied().collect::<Vec<_>>()),
        };
        let content: Vec<Level> = parts.iter().zip(&inner).map(content).collect();

        // Parts without edges stand below the others.
        let (linked, single): (Vec<usize>, Vec<usize>) = (0..parts.len()).partition(|&part| !inner[part].is_empty());
        let items = linked.iter().map(|&part| item_of(nesting, parts[part], &content[part], layers.of_part[part]));
        let item_of_part: HashMap<usize, usize> = linked.iter().enumerate().map(|(item, &part)| (part, item)).collect();
        let port = |part: usize, inside: Inside| Port {
            item: item_of_part[&part],
            port: match parts[part] {
                Part::Block(_) => inside.end.row.unwrap_or(0),
                Part::Frame(_) => content[part].port_of(inside),
            },
        };
        let mut items: Vec<Item> = items.collect();
        let mut links: Vec<(Port, Port)> = Vec::new();
        for edge in &edges {
            let left = port(edge.left_part, Inside { end: edge.left, side: Side::Right });
            links.push((left, port(edge.right_part, Inside { end: edge.right, side: Side::Left })));
        }
        for &inside in leaving {
            let at = port(part_with(inside.end), inside);
            let border = Port { item: items.len(), port: 0 };
            items.push(Item::passage(if inside.side == Side::Left { 0 } else { layers.last }));
            links.push(if inside.side == Side::Left { (border, at) } else { (at, border) });
        }
        let mut layered = Layered::of(items, &links);
        order::order(&mut layered);
        let places = Places::of(&layered);

        let mut level = Self::default();
        for (edge, &(left, right)) in edges.iter().zip(&links) {
            let points = points_of(&layered, &places, left, right);
            level.edges.insert(edge.index, Between { frame, forwards: edge.forwards, points });
        }
        for (&inside, &(left, right)) in leaving.iter().zip(&links[edges.len()..]) {
            level.leaving.insert(inside, points_of(&layered, &places, left, right));
        }
        (level.width, level.height) = (places.width, places.height);
        let mut content: Vec<Option<Level>> = content.into_iter().map(Some).collect();
        for (item, &part) in linked.iter().enumerate() {
            let (x, width) = places.layers[layered.items[item].layer];
            let x = x + ((width - layered.items[item].width) / 2.0).round();
            let content = content[part].take().unwrap_or_default();
            level.add(parts[part], content, &layered.items[item], x, places.y[item]);
        }
        level.add_singles(single.iter().map(|&part| {
            let content = content[part].take().unwrap_or_default();
            (parts[part], item_of(nesting, parts[part], &content, 0), content)
        }));
        level.surround(frame.is_some(), leaving);
        level.ports = level.ports();
        level
    }

    fn add(&mut self, part: Part, content: Level, item: &Item, x: f64, y: f64) {
        let (member, rows) = match part {
            Part::Block(block) => (Member::Block(block), item.order.clone()),
            Part::Frame(frame) => (Member::Frame(frame, content), Vec::new()),
        };
        self.members.push(PlacedMember { member, x, y, width: item.width, height: item.height, rows });
    }

    /// Puts parts without edges into lines below the others, which become about as long as these are wide.
    fn add_singles(&mut self, singles: impl Iterator<Item = (Part, Item, Level)>) {
        let singles: Vec<_> = singles.collect();
        let area: f64 = singles.iter().map(|(_, item, _)| (item.width + BETWEEN_BLOCKS) * item.height).sum();
        let longest = self.width.max((area * 2.0).sqrt());
        let (mut x, mut y, mut height) = (0.0, self.height, 0.0_f64);
        if self.height > 0.0 && !singles.is_empty() {
            y += BETWEEN_BLOCKS;
        }
        for (part, item, content) in singles {
            if x > 0.0 && x + item.width > longest {
                (x, y, height) = (0.0, y + height + BETWEEN_BLOCKS, 0.0);
            }
            self.add(part, content, &item, x, y);
            self.width = self.width.max(x + item.width);
            height = height.max(item.height);
            self.height = y + height;
            x += item.width + BETWEEN_BLOCKS;
        }
    }

    /// Leaves room between the content and the border of a frame, on the sides where no edges lead to the border.
    fn surround(&mut self, is_frame: bool, leaving: &[Inside]) {
        let open = |side: Side| leaving.iter().any(|inside| inside.side == side);
        if !is_frame {
            return;
        }
        if !open(Side::Left) {
            self.members.iter_mut().for_each(|member| member.x += BESIDE_FRAME);
            let between = self.edges.values_mut().map(|edge| &mut edge.points);
            between.chain(self.leaving.values_mut()).flatten().for_each(|point| point.x += BESIDE_FRAME);
            self.width += BESIDE_FRAME;
        }
        if !open(Side::Right) {
            self.width += BESIDE_FRAME;
        }
    }

    fn ports(&self) -> Vec<(Inside, f64)> {
        let at_border = |(inside, points): (&Inside, &Vec<Point>)| {
            let point = if inside.side == Side::Left { points.first() } else { points.last() };
            point.map(|point| (*inside, point.y))
        };
        let mut ports: Vec<(Inside, f64)> = self.leaving.iter().filter_map(at_border).collect();
        ports.sort_by(|(_, one), (_, other)| one.total_cmp(other));
        ports
    }

    /// The number of ports above one.
    fn port_of(&self, inside: Inside) -> usize {
        self.ports.iter().take_while(|(above, _)| *above != inside).count()
    }
}

/// An edge between two parts of a level, from the earlier layer to the later one.
struct Directed {
    index: usize,
    forwards: bool,
    left: End,
    right: End,
    left_part: usize,
    right_part: usize,
}

/// The edges of a level, each from left to right.
fn directed(
    nesting: &Nesting<'_>,
    frame: Option<usize>,
    parts: usize,
    part_with: &impl Fn(End) -> usize,
) -> Vec<Directed> {
    let edges = nesting.edges(frame).iter().map(|&index| (index, &nesting.diagram.edges[index]));
    let edges: Vec<_> = edges.map(|(index, it)| (index, it, part_with(it.from), part_with(it.to))).collect();
    let pairs: Vec<(usize, usize)> = edges.iter().map(|&(_, _, from, to)| (from, to)).collect();
    let places = cycles::order_of(parts, &pairs);
    let directed = |(index, edge, from, to): (usize, &crate::diagram::Edge, usize, usize)| {
        let forwards = places[from] < places[to];
        let (left, right) = if forwards { (edge.from, edge.to) } else { (edge.to, edge.from) };
        let (left_part, right_part) = if forwards { (from, to) } else { (to, from) };
        Directed { index, forwards, left, right, left_part, right_part }
    };
    edges.into_iter().map(directed).collect()
}

struct Layers {
    of_part: Vec<usize>,
    /// The layer of the points at which edges leave the frame to the right.
    last: usize,
}

/// The layers of the parts: between those of the left and the right border if edges lead there.
fn layers_with_borders(
    parts: usize,
    edges: &[Directed],
    leaving: &[Inside],
    part_with: &impl Fn(End) -> usize,
) -> Layers {
    let pairs: Vec<(usize, usize)> = edges.iter().map(|edge| (edge.left_part, edge.right_part)).collect();
    let mut of_part = layers::layers_of(parts, &pairs);
    if leaving.iter().any(|inside| inside.side == Side::Left) {
        of_part.iter_mut().for_each(|layer| *layer += 1);
    }
    let linked = edges.iter().flat_map(|edge| [edge.left_part, edge.right_part]);
    let linked = linked.chain(leaving.iter().map(|inside| part_with(inside.end)));
    let last = linked.map(|part| of_part[part] + 1).max().unwrap_or(0);
    Layers { of_part, last }
}

fn item_of(nesting: &Nesting<'_>, part: Part, content: &Level, layer: usize) -> Item {
    match part {
        Part::Block(block) => {
            let block = &nesting.diagram.blocks[block];
            let offsets = ends_of(block);
            let order = (0..offsets.len()).collect();
            Item { layer, width: width_of(block), height: height_of(block), offsets, order, is: Is::Block }
        }
        Part::Frame(_) => {
            let offsets: Vec<f64> = content.ports.iter().map(|(_, y)| ABOVE_FRAME + y).collect();
            let order = (0..offsets.len()).collect();
            let (width, height) = (content.width, ABOVE_FRAME + content.height + BELOW_FRAME);
            Item { layer, width, height, offsets, order, is: Is::Frame }
        }
    }
}

/// The points of a link, from left to right. It passes each layer between its ends in a straight line.
fn points_of(layered: &Layered, places: &Places, left: Port, right: Port) -> Vec<Point> {
    let across = |port: Port| {
        let (x, width) = places.layers[layered.items[port.item].layer];
        (x, x + width, places.of_port(layered, port))
    };
    let inset = |port: Port| ((across(port).1 - across(port).0 - layered.items[port.item].width) / 2.0).round();
    let (start, end) = (across(left), across(right));
    let item = &layered.items[left.item];
    let mut points =
        vec![Point { x: start.0 + inset(left) + item.width, y: start.2 }, Point { x: start.1, y: start.2 }];
    for &item in layered.passages(left, right) {
        let (first, last, y) = across(Port { item, port: 0 });
        points.extend([Point { x: first, y }, Point { x: last, y }]);
    }
    points.extend([Point { x: end.0, y: end.2 }, Point { x: end.0 + inset(right), y: end.2 }]);
    points.dedup();
    points
}
