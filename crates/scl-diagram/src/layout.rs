//! Where everything is drawn: in layers from left to right, so that edges lead from one layer to a later one.
//!
//! The steps are those of Sugiyama, Tagawa and Toda (1981): remove cycles, assign layers, order each layer so that few
//! edges cross, and choose coordinates. Edges end at rows, not at blocks, so the rows take part in the order. Each
//! frame is laid out by itself first, and is then a block of the picture around it, to which edges lead that end
//! within.

mod cycles;
mod layers;
mod level;
mod links;
mod metrics;
mod nesting;
mod order;
mod place;

use crate::diagram::{Diagram, Edge, End};
use level::{Between, Inside, Level, Member};
use metrics::{ABOVE_FRAME, LOOP, MARGIN, ends_of};
use nesting::{Nesting, Side};
use std::collections::HashMap;

pub(crate) use metrics::{CURVE, FONT, HEAD, RATE, ROW};

/// A position in pixels; y grows downwards.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point {
    /// From the left edge of the picture.
    pub x: f64,
    /// From its upper edge.
    pub y: f64,
}

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rectangle {
    /// Its left edge.
    pub x: f64,
    /// Its upper edge.
    pub y: f64,
    /// Its width.
    pub width: f64,
    /// Its height.
    pub height: f64,
}

/// A block with its place.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Placed {
    /// Where the block is.
    pub area: Rectangle,
    /// The indices of its rows in the order in which they are drawn.
    pub rows: Vec<usize>,
}

/// The places of a diagram.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// The width of the picture in pixels.
    pub width: f64,
    /// Its height in pixels, without notes.
    pub height: f64,
    /// Where each block is.
    pub blocks: Vec<Placed>,
    /// Where each frame is.
    pub frames: Vec<Rectangle>,
    /// The points that each edge leads through, from where it starts. It is horizontal in each of them.
    pub edges: Vec<Vec<Point>>,
}

impl Layout {
    /// Lays out a diagram. The same diagram always has the same layout.
    #[must_use]
    pub fn of(diagram: &Diagram) -> Self {
        let nesting = Nesting::of(diagram);
        let level = Level::of(&nesting, None, &[]);
        let mut drawing = Drawing {
            layout: Self {
                width: level.width + 2.0 * MARGIN,
                height: level.height + 2.0 * MARGIN,
                blocks: vec![Placed::default(); diagram.blocks.len()],
                frames: vec![Rectangle::default(); diagram.frames.len()],
                edges: Vec::new(),
            },
            between: vec![None; diagram.edges.len()],
            inside: HashMap::new(),
        };
        drawing.add(&level, None, Point { x: MARGIN, y: MARGIN });
        let edges = diagram.edges.iter().enumerate();
        drawing.layout.edges = edges.map(|(index, edge)| drawing.path(diagram, index, edge)).collect();
        drawing.layout
    }
}

struct Drawing {
    layout: Layout,
    /// The part of each edge outside the frames of its ends.
    between: Vec<Option<Between>>,
    /// The parts within a frame, from left to right, of the edges that leave it there.
    inside: HashMap<(usize, Inside), Vec<Point>>,
}

impl Drawing {
    /// Takes over the places of a level, whose upper left corner is `origin`.
    fn add(&mut self, level: &Level, frame: Option<usize>, origin: Point) {
        let moved =
            |points: &[Point]| points.iter().map(|it| Point { x: origin.x + it.x, y: origin.y + it.y }).collect();
        for (&edge, between) in &level.edges {
            self.between[edge] = Some(Between { points: moved(&between.points), ..*between });
        }
        if let Some(frame) = frame {
            self.inside.extend(level.leaving.iter().map(|(inside, points)| ((frame, *inside), moved(points))));
        }
        for placed in &level.members {
            let (x, y) = (origin.x + placed.x, origin.y + placed.y);
            let area = Rectangle { x, y, width: placed.width, height: placed.height };
            match &placed.member {
                Member::Block(block) => self.layout.blocks[*block] = Placed { area, rows: placed.rows.clone() },
                Member::Frame(inner, level) => {
                    self.layout.frames[*inner] = area;
                    self.add(level, Some(*inner), Point { x, y: y + ABOVE_FRAME });
                }
            }
        }
    }

    /// The points of an edge: out of the frames around its left end, on to the right one, and into the frames around
    /// that.
    fn path(&self, diagram: &Diagram, index: usize, edge: &Edge) -> Vec<Point> {
        if edge.from.block == edge.to.block {
            return self.loop_of(diagram, edge);
        }
        let Some(between) = &self.between[index] else { return Vec::new() };
        let (left, right) = if between.forwards { (edge.from, edge.to) } else { (edge.to, edge.from) };
        let within = |end: End, side: Side| -> Vec<&Vec<Point>> {
            let frames = diagram.frames_around(diagram.blocks[end.block].frame);
            let left = frames.take_while(|frame| Some(*frame) != between.frame);
            left.map(|frame| &self.inside[&(frame, Inside { end, side })]).collect()
        };
        let out = within(left, Side::Right).into_iter().flatten();
        let into = within(right, Side::Left).into_iter().rev().flatten();
        let mut points: Vec<Point> = out.chain(&between.points).chain(into).copied().collect();
        points.dedup();
        if !between.forwards {
            points.reverse();
        }
        points
    }

    /// The points of an edge from a block to itself, on its right side.
    fn loop_of(&self, diagram: &Diagram, edge: &Edge) -> Vec<Point> {
        let Placed { area, rows } = &self.layout.blocks[edge.from.block];
        let offsets = ends_of(&diagram.blocks[edge.from.block]);
        let y = |end: End| {
            let rank = rows.iter().position(|&row| Some(row) == end.row).unwrap_or(0);
            area.y + offsets[rank]
        };
        // The two ends of a block without rows would be the same.
        let apart = if edge.from == edge.to { LOOP / 2.0 } else { 0.0 };
        let (from, to, x) = (y(edge.from) - apart, y(edge.to) + apart, area.x + area.width);
        [(x, from), (x + LOOP, from), (x + LOOP, to), (x, to)].map(|(x, y)| Point { x, y }).to_vec()
    }
}
