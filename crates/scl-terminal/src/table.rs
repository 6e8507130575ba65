//! Tables of text: aligned columns, no wider than the terminal.

use crate::escape;
use crate::print::output_is_terminal;
use std::io::stdout;
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// Between two columns.
const GAP: &str = "  ";

/// A shortened column keeps at least this width.
const SHORTEST: usize = 6;

/// How the cells of a column are aligned.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Align {
    /// Text. It is shortened if the table is too wide.
    Left,
    /// Numbers. They are never shortened.
    Right,
}

/// Rows of cells under headings.
///
/// ```
/// use scl_terminal::{Align, Table};
///
/// let mut table = Table::new([("GATE", Align::Left), ("RATE", Align::Right)]);
/// table.row(["sensor.measurements", "50.0"]);
/// table.row(["sensor.log", "1000.0"]);
/// assert_eq!(
///     table.fit(24),
///     "GATE                RATE\nsensor.measurem…    50.0\nsensor.log        1000.0\n"
/// );
/// ```
#[derive(Debug, Clone)]
pub struct Table {
    aligns: Vec<Align>,
    headings: Option<Vec<String>>,
    rows: Vec<Vec<String>>,
    indent: usize,
}

impl Table {
    /// A table with these columns.
    pub fn new<'h>(columns: impl IntoIterator<Item = (&'h str, Align)>) -> Self {
        let (headings, aligns) = columns.into_iter().map(|(heading, align)| (heading.to_owned(), align)).unzip();
        Self { aligns, headings: Some(headings), rows: Vec::new(), indent: 0 }
    }

    /// A table with columns of text, followed by columns of numbers.
    pub fn with_headings<'h>(texts: &[&'h str], numbers: &[&'h str]) -> Self {
        let texts = texts.iter().map(|heading| (*heading, Align::Left));
        Self::new(texts.chain(numbers.iter().map(|heading| (*heading, Align::Right))))
    }

    /// A table of this many columns of text, without headings.
    pub fn plain(columns: usize) -> Self {
        Self { aligns: vec![Align::Left; columns], headings: None, rows: Vec::new(), indent: 0 }
    }

    /// Starts each line with this many spaces.
    #[must_use]
    pub fn indented(mut self, indent: usize) -> Self {
        self.indent = indent;
        self
    }

    /// Adds a row. Missing cells are empty, surplus ones are dropped. Control characters are shown as escapes.
    pub fn row<C: AsRef<str>>(&mut self, cells: impl IntoIterator<Item = C>) {
        let mut row: Vec<String> = cells.into_iter().map(|cell| escape(cell.as_ref()).into_owned()).collect();
        row.resize(self.aligns.len(), String::new());
        self.rows.push(row);
    }

    /// Whether the table has no rows.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The table as text for standard output; see [`output_width`].
    pub fn text(&self) -> String {
        self.fit(output_width())
    }

    /// The table as text with lines of at most `width` columns, if shortening the columns of text allows that: the
    /// widest are cut first, and end in `…`.
    pub fn fit(&self, width: usize) -> String {
        let widths = self.widths(width);
        self.lines().map(|row| self.line(row, &widths)).collect()
    }

    fn lines(&self) -> impl Iterator<Item = &Vec<String>> {
        self.headings.iter().chain(&self.rows)
    }

    fn widths(&self, limit: usize) -> Vec<usize> {
        let width = |column: usize| self.lines().map(|row| row[column].width()).max().unwrap_or(0);
        let mut widths: Vec<usize> = (0..self.aligns.len()).map(width).collect();
        let gaps = GAP.len() * widths.len().saturating_sub(1);
        let mut surplus = (self.indent + gaps + widths.iter().sum::<usize>()).saturating_sub(limit);
        while surplus > 0 {
            let text = (0..widths.len()).filter(|&it| self.aligns[it] == Align::Left && widths[it] > SHORTEST);
            let Some(widest) = text.max_by_key(|&it| widths[it]) else { break };
            widths[widest] -= 1;
            surplus -= 1;
        }
        widths
    }

    fn line(&self, row: &[String], widths: &[usize]) -> String {
        let cells = row.iter().zip(widths).zip(&self.aligns).map(|((cell, &width), align)| {
            let cell = shorten(cell, width);
            let padding = " ".repeat(width.saturating_sub(cell.width()));
            match align {
                Align::Left => cell + &padding,
                Align::Right => padding + &cell,
            }
        });
        let line = cells.collect::<Vec<_>>().join(GAP);
        format!("{}{}\n", " ".repeat(self.indent), line.trim_end())
    }
}

/// Returns the width of the terminal, or `usize::MAX` if standard output is not a terminal, so that pipes and files get
/// everything.
pub fn output_width() -> usize {
    let terminal = output_is_terminal().then(|| rustix::termios::tcgetwinsize(stdout()).ok()).flatten();
    // A terminal that does not know its size reports 0.
    terminal.map(|size| usize::from(size.ws_col)).filter(|&width| width > 0).unwrap_or(usize::MAX)
}

/// Cuts a text to this width, with `…` at its end if something is missing.
pub fn shorten(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_owned();
    }
    let mut used = 1;
    let kept = text.chars().take_while(|c| {
        used += c.width().unwrap_or(0);
        used <= width
    });
    let kept: String = kept.collect();
    if width == 0 { String::new() } else { kept + "…" }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let mut table = Table::new([("GATE", Align::Left), ("TYPE", Align::Left), ("RATE", Align::Right)]);
        table.row(["sensor.measurements", "rover.Measurement", "50.0"]);
        table.row(["sensor.log", "", "1000.0"]);
        table
    }

    #[test]
    fn columns_are_aligned() {
        let expected = "\
GATE                 TYPE                 RATE
sensor.measurements  rover.Measurement    50.0
sensor.log                              1000.0
";
        assert_eq!(table().fit(80), expected);
    }

    #[test]
    fn the_widest_text_is_shortened_and_numbers_never() {
        let expected = "\
GATE          TYPE            RATE
sensor.meas…  rover.Measu…    50.0
sensor.log                  1000.0
";
        assert_eq!(table().fit(34), expected);
        // There is no room for less.
        assert_eq!(table().fit(3).lines().next().unwrap().width(), 6 + 2 + 6 + 2 + 6);
    }

    #[test]
    fn wide_characters_and_control_characters_keep_the_columns() {
        let mut table = Table::new([("A", Align::Left), ("B", Align::Left)]).indented(2);
        table.row(["速度速度速度", "x"]);
        table.row(["a\x1b[0m\n", "y"]);
        assert_eq!(table.fit(14), "  A          B\n  速度速度…  x\n  a\\u{1b}[…  y\n");
    }

    #[test]
    fn texts_are_cut_to_a_width() {
        for (width, expected) in [(9, "速度speed"), (8, "速度spe…"), (4, "速…"), (1, "…"), (0, "")] {
            assert_eq!(shorten("速度speed", width), expected, "{width}");
        }
    }
}
