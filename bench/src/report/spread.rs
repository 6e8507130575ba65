//! How the times of a table are distributed: the last percents as figures, the whole as a line.

use super::Table;
use super::grid::Grid;
use super::text::shortened;
use crate::histogram::Times;

const PARTS: [(&str, f64); 5] = [("50%", 0.5), ("90%", 0.9), ("99%", 0.99), ("99.9%", 0.999), ("99.99%", 0.9999)];

/// Characters of the line of a row.
const CELLS: usize = 40;

/// Below a table: nothing if it has no times.
pub(super) fn spread(table: &Table) -> String {
    let rows: Vec<(&str, &Times)> =
        table.rows.iter().filter_map(|row| Some((row.name.as_str(), row.times.as_ref()?))).collect();
    if rows.is_empty() {
        return String::new();
    }
    let least = rows.iter().map(|(_, times)| times.least()).fold(f64::INFINITY, f64::min);
    let greatest = rows.iter().map(|(_, times)| times.greatest()).fold(0.0, f64::max);
    let mut grid = Grid::new(rows.iter().map(|(name, _)| (*name).to_owned()).collect());
    for (heading, part) in PARTS {
        grid.add((heading.to_owned(), rows.iter().map(|(_, times)| shortened(times.quantile(part))).collect()));
    }
    grid.add(("max".to_owned(), rows.iter().map(|(_, times)| shortened(times.greatest())).collect()));
    let lines = rows.iter().map(|(_, times)| line(times, least, greatest)).collect();
    let [least, greatest] = [least, greatest].map(shortened);
    grid.add_group(&format!("{least} us to {greatest} us, logarithmic"), vec![(String::new(), lines)]);
    format!("times in us that so many do not exceed; . marks up to 0.1 % of them, : 1 %, + 10 %, # more\n{grid}")
}

fn line(times: &Times, least: f64, greatest: f64) -> String {
    let marks = times.shares(least, greatest, CELLS).into_iter().map(mark);
    format!("|{}|", marks.collect::<String>())
}

fn mark(share: f64) -> char {
    match share {
        0.0 => ' ',
        ..=0.001 => '.',
        ..=0.01 => ':',
        ..=0.1 => '+',
        _ => '#',
    }
}
