//! The distribution of the durations of a table: quantiles, and a line of logarithmic bins.

use super::Table;
use super::text_table::{format_value, text_table};
use crate::durations::Durations;

const QUANTILES: [(&str, f64); 5] = [("50%", 0.5), ("90%", 0.9), ("99%", 0.99), ("99.9%", 0.999), ("99.99%", 0.9999)];

/// Number of bins: few enough that a line with six quantiles fits into 100 columns.
const BINS: usize = 16;

/// Lines to print below a table; empty if it has no durations.
pub(super) fn distribution(table: &Table) -> String {
    let rows: Vec<(&str, &Durations)> =
        table.rows.iter().filter_map(|row| Some((row.name.as_str(), row.durations.as_ref()?))).collect();
    if rows.is_empty() {
        return String::new();
    }
    let min = rows.iter().map(|(_, durations)| durations.min()).fold(f64::INFINITY, f64::min);
    let max = rows.iter().map(|(_, durations)| durations.max()).fold(0.0, f64::max);
    let headings = QUANTILES.iter().map(|(heading, _)| *heading).chain(["max", ""]);
    let mut text = text_table("", headings.map(str::to_owned));
    for (name, durations) in rows {
        let quantiles = QUANTILES.iter().map(|(_, fraction)| durations.quantile(*fraction));
        let cells = quantiles.chain([durations.max()]).map(format_value).chain([line(durations, min, max)]);
        text.row(std::iter::once(name.to_owned()).chain(cells));
    }
    let text = text.fit(usize::MAX);
    let [min, max] = [min, max].map(format_value);
    format!("quantiles in us; bins from {min} to {max} us: . up to 0.1 % of all, : 1 %, + 10 %, # more\n{text}")
}

fn line(durations: &Durations, min: f64, max: f64) -> String {
    let marks = durations.log_bins(min, max, BINS).into_iter().map(mark);
    format!("|{}|", marks.collect::<String>())
}

fn mark(fraction: f64) -> char {
    match fraction {
        0.0 => ' ',
        ..=0.001 => '.',
        ..=0.01 => ':',
        ..=0.1 => '+',
        _ => '#',
    }
}
