//! Tables of text, and the values in them.

use scl_terminal::Table;

/// A table of text: names at the left, below `heading`, and right-aligned columns.
pub(super) fn text_table(heading: &str, columns: impl Iterator<Item = String>) -> Table {
    let columns: Vec<String> = columns.collect();
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    Table::with_headings(&[heading], &columns)
}

/// Formats a value with two decimals, or with none if it is whole or at least 1000.
pub(super) fn format_value(value: f64) -> String {
    let digits = if value.fract() == 0.0 || value.abs() >= 1000.0 { 0 } else { 2 };
    format!("{value:.digits$}")
}
