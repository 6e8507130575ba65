//! The drawing as SVG: one file without links to others, light or dark as the viewer's desktop is.

use crate::diagram::{Block, Diagram, Edge, End, Row};
use crate::layout::{CURVE, FONT, HEAD, Layout, Placed, Point, RATE, ROW, Rectangle};
use crate::text;
use std::collections::HashMap;
use std::fmt::{self, Write as _};

const STYLE: &str = include_str!("svg/style.css");
/// What is added for a running system.
const LIVE_STYLE: &str = include_str!("svg/live.css");
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
    let live = if diagram.blocks.iter().any(|block| block.state.is_some()) { LIVE_STYLE } else { "" };
    writeln!(out, "<title>{}</title>\n<style>\n{STYLE}{live}</style>", escape(&diagram.title))?;
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
    for (index, (edge, points)) in diagram.edges.iter().zip(&layout.edges).enumerate() {
        write_edge(out, index, edge, points)?;
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

fn write_edge(out: &mut String, index: usize, edge: &Edge, points: &[Point]) -> fmt::Result {
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
    let live = edge.flow.map_or_else(String::new, |flow| {
        let width = flow.width();
        format!(" flow-{}\" data-part=\"edge {index}\" style=\"--width:{width:.1}", flow.word())
    });
    let start = if edge.both_ways { " marker-start=\"url(#arrow)\"" } else { "" };
    let mut details = edge.details.iter().take(MOST_DETAILS).map(|it| escape(it)).collect::<Vec<_>>().join("\n");
    if let Some(more) = edge.details.len().checked_sub(MOST_DETAILS + 1) {
        write!(details, "\nand {} more", more + 1)?;
    }
    writeln!(
        out,
        "<g class=\"{class}{live}\"><title>{details}</title><path class=\"reach\" d=\"{path}\"/>\
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
    let live = block.state.map_or_else(String::new, |state| {
        let names = names_of(block);
        let attribute = if block.others.is_empty() { "data-component" } else { "data-stack" };
        format!(" state-{}\" data-part=\"block {index}\" {attribute}=\"{names}\" tabindex=\"0", state.word())
    });
    write!(out, "<g class=\"block{live}\"><title>{}</title>", names_of(block))?;
    let behind: &[f64] = if block.others.is_empty() { &[] } else { &[6.0, 3.0] };
    for by in behind {
        let (x, y) = (x + by, y + by);
        write!(out, "<rect class=\"border\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"5\"/>")?;
    }
    write!(out, "<rect class=\"border\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"5\"/>")?;
    let head = if block.rows.is_empty() { height } else { HEAD };
    let (middle, base) = (x + width / 2.0, y + head / 2.0 + 4.5);
    write!(out, "<text class=\"name\" x=\"{middle}\" y=\"{base}\">{}</text>", escape(&block.title))?;
    if let Some(state) = block.state {
        let right = x + width - BESIDE_TEXT;
        write!(out, "<text class=\"badge right\" x=\"{right}\" y=\"{base}\">{}</text>", state.badge())?;
    }
    if !block.rows.is_empty() {
        write!(out, "<path class=\"line\" d=\"M{x} {}h{width}\"/>", y + HEAD)?;
    }
    for (place, &row) in placed.rows.iter().enumerate().take(block.rows.len()) {
        let is_right = facing.is_right(End { block: index, row: Some(row) });
        let area = Rectangle { x, y: y + HEAD + ROW * place as f64, width, height: ROW };
        write_row(out, &format!("{index} {row}"), block, &block.rows[row], area, is_right)?;
    }
    out.push_str("</g>\n");
    Ok(())
}

/// The names of its components.
fn names_of(block: &Block) -> String {
    escape(&block.components().collect::<Vec<_>>().join(" "))
}

/// Writes a row. Its name is on the side that faces its peers.
fn write_row(out: &mut String, part: &str, block: &Block, row: &Row, area: Rectangle, is_right: bool) -> fmt::Result {
    let (left, right, y) = (area.x + BESIDE_TEXT, area.x + area.width - BESIDE_TEXT, area.y + ROW / 2.0 + 4.0);
    let (name_at, other_at) = if is_right { (right, left) } else { (left, right) };
    let (name_class, other_class) = if is_right { ("gate right", "") } else { ("gate", " right") };
    let name = escape(&row.name);
    let name_text = format!("<text class=\"{name_class}\" x=\"{name_at}\" y=\"{y}\">{name}</text>");
    let kind = if row.types.is_empty() { row.kind.clone() } else { format!("{} {}", row.kind, row.types) };
    let kind = escape(&kind);
    let Some(figures) = &row.figures else {
        return write!(out, "{name_text}<text class=\"kind{other_class}\" x=\"{other_at}\" y=\"{y}\">{kind}</text>");
    };
    let bad = if figures.is_bad { " bad" } else { "" };
    write!(out, "<g class=\"row{bad}\" data-part=\"row {part}\" ")?;
    if block.others.is_empty() {
        let gate = format!("{}.{name}", escape(&block.name));
        write!(out, "data-gate=\"{gate}\" tabindex=\"0\"><title>{gate}: {kind}</title>")?;
    } else {
        write!(out, "><title>{name}: {kind}</title>")?;
    }
    let Rectangle { x, y: top, width, height } = area;
    write!(out, "<rect class=\"reach\" x=\"{x}\" y=\"{top}\" width=\"{width}\" height=\"{height}\"/>")?;
    // How full the queue is, as a line at the lower edge.
    let (most, bottom) = (width - 2.0, top + height - 3.0);
    let filled = most * figures.filled;
    write!(
        out,
        "<rect class=\"filled\" data-most=\"{most}\" x=\"{}\" y=\"{bottom}\" width=\"{filled:.1}\" height=\"2\"/>",
        x + 1.0
    )?;
    let curve = if is_right { left } else { right - RATE - CURVE };
    let rate = if is_right { left + CURVE + RATE } else { right };
    let (rate_text, trouble) = (escape(&figures.rate), escape(&figures.trouble));
    write!(
        out,
        "{name_text}<path class=\"spark\" data-area='{{\"x\":{curve},\"y\":{},\"width\":{},\"height\":{}}}'/>\
         <text class=\"rate right\" x=\"{rate}\" y=\"{y}\">{rate_text}</text>\
         <text class=\"trouble\" x=\"{curve}\" y=\"{y}\">{trouble}</text></g>",
        top + 4.0,
        CURVE - 4.0,
        ROW - 9.0
    )
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
