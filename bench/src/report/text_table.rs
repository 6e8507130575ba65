//! A table of text with aligned columns.

use std::fmt;

/// Rows with a name at the left, and right-aligned columns.
pub(super) struct TextTable {
    heading: &'static str,
    names: Vec<String>,
    columns: Vec<TextColumn>,
}

/// A heading and one cell per row.
struct TextColumn {
    heading: String,
    cells: Vec<String>,
}

impl TextTable {
    /// A table without columns; `heading` stands above the names.
    pub(super) fn new(heading: &'static str, names: Vec<String>) -> Self {
        Self { heading, names, columns: Vec::new() }
    }

    pub(super) fn add(&mut self, heading: impl Into<String>, cells: Vec<String>) {
        self.columns.push(TextColumn { heading: heading.into(), cells });
    }

    fn write_line<'a>(
        &'a self,
        f: &mut fmt::Formatter<'_>,
        name: &str,
        cell: impl Fn(&'a TextColumn) -> &'a str,
    ) -> fmt::Result {
        let width = self.names.iter().map(String::len).fold(self.heading.len(), usize::max);
        let cells = self.columns.iter().map(|column| format!("  {:>1$}", cell(column), column.width()));
        writeln!(f, "{}", format!("{name:width$}{}", cells.collect::<String>()).trim_end())
    }
}

impl fmt::Display for TextTable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.write_line(f, self.heading, |column| &column.heading)?;
        for (row, name) in self.names.iter().enumerate() {
            self.write_line(f, name, |column| column.cells.get(row).map_or("", String::as_str))?;
        }
        Ok(())
    }
}

impl TextColumn {
    fn width(&self) -> usize {
        self.cells.iter().map(String::len).fold(self.heading.len(), usize::max)
    }
}

/// About four digits, whatever the magnitude.
pub(super) fn format_value(value: f64) -> String {
    let digits = if value.fract() == 0.0 || value.abs() >= 1000.0 { 0 } else { 2 };
    format!("{value:.digits$}")
}
