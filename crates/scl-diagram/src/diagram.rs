//! What is drawn: blocks with rows, frames around blocks, and edges between rows or whole blocks.

use crate::live::{Figures, Flow, State};

/// A picture without positions.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Diagram {
    /// The name of the system.
    pub title: String,
    /// The frames; each stands behind the frame that it is in.
    pub frames: Vec<Frame>,
    /// The blocks: one for each component.
    pub blocks: Vec<Block>,
    /// The edges: one for each connection, or for all connections of two components.
    pub edges: Vec<Edge>,
    /// Lines of text below the picture.
    pub notes: Vec<String>,
}

/// A rectangle around a group of components.
#[derive(Debug, Clone, PartialEq)]
pub struct Frame {
    /// The text in its upper left corner.
    pub title: String,
    /// The frame that it is in.
    pub parent: Option<usize>,
}

/// A component, or a stack of components of one kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Its full name: `arm.planner`; of a stack, that of its first component.
    pub name: String,
    /// The full names of the other components of a stack.
    pub others: Vec<String>,
    /// The text in its head: the name within its group, or `wheel ×4`.
    pub title: String,
    /// Its gates; none if the picture shows components only.
    pub rows: Vec<Row>,
    /// The frame that it is in.
    pub frame: Option<usize>,
    /// What it is doing; `None` in a picture of a topology.
    pub state: Option<State>,
}

/// A gate.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its name.
    pub name: String,
    /// Its kind: `pub`.
    pub kind: String,
    /// What it carries, without the names of packages; empty for bytes.
    pub types: String,
    /// What it has done, in place of kind and types; `None` in a picture of a topology.
    pub figures: Option<Figures>,
}

/// One end of an edge: a row of a block, or the whole block.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct End {
    /// The index of the block.
    pub block: usize,
    /// The index of the row; `None` for a block without rows.
    pub row: Option<usize>,
}

/// What two ends exchange.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// The end that sends or asks.
    pub from: End,
    /// The end that receives or answers.
    pub to: End,
    /// Whether messages go from `to` to `from` too: answers, or other connections of the same components.
    pub both_ways: bool,
    /// Whether all messages are requests and their answers.
    pub asks: bool,
    /// What a viewer reads who points at the edge, one connection per line.
    pub details: Vec<String>,
    /// Its connections: the gate that sends and the gate that receives, each as `component.gate`.
    pub connections: Vec<(String, String)>,
    /// What flows through it; `None` in a picture of a topology.
    pub flow: Option<Flow>,
}

impl Block {
    /// The full names of its components.
    pub fn components(&self) -> impl Iterator<Item = &str> {
        std::iter::once(&self.name).chain(&self.others).map(String::as_str)
    }
}

impl Diagram {
    /// The frame that a block or frame is in, then the frame around that, and so on.
    pub(crate) fn frames_around(&self, innermost: Option<usize>) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(innermost, |&frame| self.frames[frame].parent)
    }
}
