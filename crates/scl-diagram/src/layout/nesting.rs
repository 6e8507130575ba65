//! Which blocks and frames are in which frame, and which edges have both ends in it but not in the same part of it.

use crate::diagram::{Diagram, End};
use std::collections::HashMap;

/// The side of a block or frame at which an edge ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum Side {
    Left,
    Right,
}

/// What stands directly in a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Part {
    Block(usize),
    Frame(usize),
}

/// The parts and edges of each frame; `None` is the whole picture.
pub(crate) struct Nesting<'d> {
    pub(crate) diagram: &'d Diagram,
    parts: HashMap<Option<usize>, Vec<Part>>,
    edges: HashMap<Option<usize>, Vec<usize>>,
}

impl<'d> Nesting<'d> {
    pub(crate) fn of(diagram: &'d Diagram) -> Self {
        let mut nesting = Self { diagram, parts: HashMap::new(), edges: HashMap::new() };
        // Blocks first, in the order in which a frame has its first block.
        let mut known = vec![false; diagram.frames.len()];
        for (index, block) in diagram.blocks.iter().enumerate() {
            nesting.parts.entry(block.frame).or_default().push(Part::Block(index));
            for frame in diagram.frames_around(block.frame) {
                if std::mem::replace(&mut known[frame], true) {
                    break;
                }
                nesting.parts.entry(diagram.frames[frame].parent).or_default().push(Part::Frame(frame));
            }
        }
        for (index, edge) in diagram.edges.iter().enumerate() {
            if edge.from.block != edge.to.block {
                nesting.edges.entry(nesting.common_frame(edge.from, edge.to)).or_default().push(index);
            }
        }
        nesting
    }

    /// What stands directly in a frame.
    pub(crate) fn parts(&self, frame: Option<usize>) -> &[Part] {
        self.parts.get(&frame).map_or(&[], Vec::as_slice)
    }

    /// The edges between two parts of a frame.
    pub(crate) fn edges(&self, frame: Option<usize>) -> &[usize] {
        self.edges.get(&frame).map_or(&[], Vec::as_slice)
    }

    /// The part of a frame that an end within the frame belongs to.
    pub(crate) fn part_with(&self, frame: Option<usize>, end: End) -> Part {
        let mut part = Part::Block(end.block);
        for around in self.diagram.frames_around(self.diagram.blocks[end.block].frame) {
            if Some(around) == frame {
                break;
            }
            part = Part::Frame(around);
        }
        part
    }

    /// The innermost frame that has both ends.
    fn common_frame(&self, one: End, other: End) -> Option<usize> {
        let around = |end: End| self.diagram.frames_around(self.diagram.blocks[end.block].frame);
        let others: Vec<usize> = around(other).collect();
        around(one).find(|frame| others.contains(frame))
    }
}
