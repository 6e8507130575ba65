//! Sizes in pixels.

use crate::diagram::Block;
use crate::text::width;

/// Around the picture.
pub(crate) const MARGIN: f64 = 16.0;
/// The head of a block, with its name.
pub(crate) const HEAD: f64 = 26.0;
/// A row of a block.
pub(crate) const ROW: f64 = 20.0;
/// Below the last row.
const FOOT: f64 = 4.0;
/// A block without rows.
const BARE: f64 = 34.0;
/// The least width of a block.
const NARROWEST: f64 = 90.0;
/// Between the texts of a row, and beside them.
const BESIDE_TEXT: f64 = 12.0;
/// Within a frame, above its content: its title.
pub(crate) const ABOVE_FRAME: f64 = 28.0;
/// Within a frame, below its content.
pub(crate) const BELOW_FRAME: f64 = 14.0;
/// Within a frame, beside its content where no edge leaves it.
pub(crate) const BESIDE_FRAME: f64 = 14.0;
/// Between two blocks of a layer.
pub(crate) const BETWEEN_BLOCKS: f64 = 22.0;
/// Between an edge that passes through a layer and its neighbours there.
pub(crate) const BETWEEN_EDGES: f64 = 10.0;
/// The least width of the space between two layers.
pub(crate) const NARROWEST_GAP: f64 = 48.0;
/// The greatest width of the space between two layers.
pub(crate) const WIDEST_GAP: f64 = 150.0;
/// How far an edge from a block to itself is from the block.
pub(crate) const LOOP: f64 = 14.0;
/// The part of a row with the figures of a gate: a curve, and to its right the rate.
pub(crate) const CURVE: f64 = 40.0;
pub(crate) const RATE: f64 = 40.0;
const FIGURES: f64 = CURVE + RATE;
/// The room for the word that says what a component is doing.
const BADGE: f64 = 52.0;
/// The size of names, and of all other texts of rows.
pub(crate) const FONT: f64 = 12.0;
const SMALL_FONT: f64 = 10.0;

/// The width of a block.
pub(crate) fn width_of(block: &Block) -> f64 {
    let badges = if block.state.is_some() { 2.0 * BADGE } else { 0.0 }; // the title stays in the middle
    let head = width(&block.title) * FONT * 1.08 + badges + 2.0 * BESIDE_TEXT; // bold
    let rows = block.rows.iter().map(|row| {
        let small = match row.figures {
            Some(_) => FIGURES,
            None => (width(&row.kind) + width(" ") + width(&row.types)) * SMALL_FONT,
        };
        width(&row.name) * FONT + small + 3.0 * BESIDE_TEXT
    });
    rows.fold(head.max(NARROWEST), f64::max).round()
}

/// The height of a block.
pub(crate) fn height_of(block: &Block) -> f64 {
    if block.rows.is_empty() { BARE } else { HEAD + ROW * block.rows.len() as f64 + FOOT }
}

/// The distances of the rows' middles from the upper edge of a block, or that of its own middle if it has no rows.
pub(crate) fn ends_of(block: &Block) -> Vec<f64> {
    match block.rows.len() {
        0 => vec![BARE / 2.0],
        rows => (0..rows).map(|row| HEAD + ROW * (row as f64 + 0.5)).collect(),
    }
}
