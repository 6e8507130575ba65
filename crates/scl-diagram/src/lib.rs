//! Pictures of systems, for `scl graph` and `scl watch`: a [`Diagram`] says what is drawn, [`Layout`] where, and
//! [`draw`] writes both as SVG.

mod diagram;
mod layout;
mod live;
mod stacks;
mod svg;
mod system;
mod text;

pub use diagram::{Block, Diagram, Edge, End, Frame, Row};
pub use layout::{Layout, Placed, Point, Rectangle};
pub use live::{Figures, Flow, State};
pub use svg::draw;
pub use system::{Detail, Options, diagram_of};
