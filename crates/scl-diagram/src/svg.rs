//! The drawing as SVG: one file without links to others, light or dark as the viewer's desktop is.

use crate::diagram::{Block, Diagram, Edge, End};
use crate::layout::{FONT, HEAD, Layout, Placed, Point, ROW};
use crate::text;
use std::collections::HashMap;
use std::fmt::{self, Write as _};

const STYLE: &str = include_str!("svg/style.css");
/// The heads of arrows, for the ends of edges.
const ARROWS: &str = r#"<defs><marker id="arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" markerUnits="userSpaceOnUse" orient="auto-start-reverse"><path class="arrow" d="M0 0.5L8 4L0 7.5Z"/></marker></defs>
"#;
/// Between the border of a block and a text.
const BESIDE_TEXT: f64 = 9.0;
/// Beside the notes, and the height of a line.
const NOTE: f64 = 16.0;
/// Maximum number of lines that a viewer sees who points at an edge.
const MOST_DETAILS: usize = 20;

/// Draws a diagram.
#[must_use]
pub fn draw(diagram: &Diagram, layout: &Layout) -> String {
    let mut out = String::new();
    _ = write_all(&mut out, diagram, layout); // a string accepts all that is written to it
    out
}

fn write_all(out: &mut String, diagram: &Diagram, layout: &Layout) -> fmt::Result {
    let notes = diagram.notes.iter().map(|note| (text::width(note) * FONT).ceil() + 2.0 * NOTE);
    let width = notes.fold(layout.width, f64::max);
    let height = layout.height + diagram.notes.len() as f64 * NOTE;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"scl\" role=\"img\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\">"
    )?;
    writeln!(out, "<title>{}</title>\n<style>\n{STYLE}</style>", escape(&diagram.title))?;
    out.push_str(ARROWS);
    writeln!(out, "<rect class=\"ground\" width=\"{width}\" height=\"{height}\"/>")?;
    for (frame, area) in diagram.frames.iter().zip(&layout.frames) {
        let title = escape(&frame.title);
        writeln!(
            out,
            "<g class=\"frame\"><rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" rx=\"8\"/>\
             <text x=\"{}\" y=\"{}\">{title}</text></g>",
            area.x,
            area.y,
            area.width,
            area.height,
            area.x + BESIDE_TEXT,
            area.y + 18.0
        )?;
    }
    for (edge, points) in diagram.edges.iter().zip(&layout.edges) {
        write_edge(out, edge, points)?;
    }
    let facing = Facing::of(diagram, layout);
    for (index, (block, placed)) in diagram.blocks.iter().zip(&layout.blocks).enumerate() {
        write_block(out, index, block, placed, &facing)?;
    }
    for (line, note) in diagram.notes.iter().enumerate() {
        let y = layout.height + line as f64 * NOTE;
        writeln!(out, "<text class=\"note\" x=\"{NOTE}\" y=\"{y}\">{}</text>", escape(note))?;
    }
    out.push_str("</svg>\n");
    Ok(())
}

fn write_edge(out: &mut String, edge: &Edge, points: &[Point]) -> fmt::Result {
    let [first, rest @ ..] = points else { return Ok(()) };
    let mut path = format!("M{} {}", first.x, first.y);
    let mut at = first;
    for point in rest {
        if point.y == at.y {
            write!(path, "H{}", point.x)?;
        } else {
            let middle = (at.x + point.x) / 2.0;
            write!(path, "C{middle} {} {middle} {} {} {}", at.y, point.y, point.x, point.y)?;
        }
        at = point;
    }
    let class = if edge.asks { "edge asks" } else { "edge" };
    let start = if edge.both_ways { " marker-start=\"url(#arrow)\"" } else { "" };
    let mut details = edge.details.iter().take(MOST_DETAILS).map(|it| escape(it)).collect::<Vec<_>>().join("\n");
    if let Some(more) = edge.details.len().checked_sub(MOST_DETAILS + 1) {
        write!(details, "\nand {} more", more + 1)?;
    }
    writeln!(
        out,
        "<g class=\"{class}\"><title>{details}</title><path class=\"reach\" d=\"{path}\"/>\
         <path d=\"{path}\"{start} marker-end=\"url(#arrow)\"/></g>"
    )
}

/// The rows at which all edges end on the right side.
struct Facing(HashMap<End, bool>);

impl Facing {
    fn of(diagram: &Diagram, layout: &Layout) -> Self {
        let mut right = HashMap::new();
        for (edge, points) in diagram.edges.iter().zip(&layout.edges) {
            for (end, point) in [(edge.from, points.first()), (edge.to, points.last())] {
                let area = layout.blocks[end.block].area;
                let is_right = point.is_some_and(|point| point.x > area.x + area.width / 2.0);
                right.entry(end).and_modify(|all| *all &= is_right).or_insert(is_right);
            }
        }
        Self(right)
    }

    fn is_right(&self, end: End) -> bool {
        self.0.get(&end).copied().unwrap_or(false)
    }
}

fn write_block(out: &mut String, index: usize, block: &Block, placed: &Placed, facing: &Facing) -> fmt::Result {
    let area = placed.area;
    let (x, y, width, height) = (area.x, area.y, area.width, area.height);
    write!(out, "<g class=\"block\"><title>{}</title>", escape(&block.name))?;
    write!(out, "<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"5\"/>")?;
    let head = if block.rows.is_empty() { height } else { HEAD };
    let middle = (x + width / 2.0, y + head / 2.0 + 4.5);
    write!(out, "<text class=\"name\" x=\"{}\" y=\"{}\">{}</text>", middle.0, middle.1, escape(&block.title))?;
    if !block.rows.is_empty() {
        write!(out, "<path class=\"line\" d=\"M{x} {}h{width}\"/>", y + HEAD)?;
    }
    for (place, &row) in placed.rows.iter().enumerate().take(block.rows.len()) {
        let y = y + HEAD + ROW * place as f64 + ROW / 2.0 + 4.0;
        let (left, right) = (x + BESIDE_TEXT, x + width - BESIDE_TEXT);
        let is_right = facing.is_right(End { block: index, row: Some(row) });
        let row = &block.rows[row];
        let (name_at, kind_at) = if is_right { (right, left) } else { (left, right) };
        let (name_class, kind_class) = if is_right { ("gate right", "kind") } else { ("gate", "kind right") };
        let kind = if row.types.is_empty() { row.kind.clone() } else { format!("{} {}", row.kind, row.types) };
        write!(out, "<text class=\"{name_class}\" x=\"{name_at}\" y=\"{y}\">{}</text>", escape(&row.name))?;
        write!(out, "<text class=\"{kind_class}\" x=\"{kind_at}\" y=\"{y}\">{}</text>", escape(&kind))?;
    }
    out.push_str("</g>\n");
    Ok(())
}

/// Escapes a text for SVG. Control characters, which XML does not allow, become spaces.
fn escape(text: &str) -> String {
    let mut escaped = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            '"' => escaped.push_str("&quot;"),
            it if it.is_control() || matches!(it, '\u{fffe}' | '\u{ffff}') => escaped.push(' '),
            it => escaped.push(it),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::escape;

    #[test]
    fn texts_are_escaped() {
        assert_eq!(escape("<a & \"b\">\u{7}\u{ffff}"), "&lt;a &amp; &quot;b&quot;&gt;  ");
    }
}
