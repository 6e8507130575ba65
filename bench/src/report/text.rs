//! A report for people: figures, and beside them their ratios to other rows.

use super::grid::{Cells, Grid};
use super::spread::spread;
use super::{Report, Table};
use std::fmt;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, table) in self.tables.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{}\n{}", table.title, grid(table))?;
            if f.alternate() {
                f.write_str(&spread(table))?;
            }
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}

fn grid(table: &Table) -> Grid {
    let mut grid = Grid::new(table.rows.iter().map(|row| row.name.clone()).collect());
    for (index, column) in table.columns.iter().enumerate() {
        let figures = table.rows.iter().filter_map(|row| row.figures.get(index));
        grid.add((column.heading(), figures.map(|figure| shortened(*figure)).collect()));
    }
    let labels = labels(table);
    for (index, column) in table.columns.iter().enumerate().filter(|(_, column)| column.compared) {
        let ratios = labels.iter().map(|label| ratios(table, index, label)).collect();
        grid.add_group(&format!("{} ratio to", column.heading()), ratios);
    }
    grid
}

/// Every label under which some row has a ratio, in the order of the rows.
fn labels(table: &Table) -> Vec<&'static str> {
    let mut labels = Vec::new();
    for (label, _) in table.rows.iter().flat_map(|row| table.others(row)) {
        if !labels.contains(&label) {
            labels.push(label);
        }
    }
    labels
}

fn ratios(table: &Table, column: usize, label: &str) -> Cells {
    let ratio = |row| {
        let (_, other) = table.others(row).find(|(other, _)| *other == label)?;
        table.ratio(row, other, column)
    };
    let cells = table.rows.iter().map(|row| ratio(row).map_or_else(String::new, |ratio| format!("{ratio:.2}")));
    (label.to_owned(), cells.collect())
}

/// Four digits or so, whatever the size.
pub(super) fn shortened(figure: f64) -> String {
    let digits = if figure.fract() == 0.0 || figure.abs() >= 1000.0 { 0 } else { 2 };
    format!("{figure:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::super::{Column, Row};
    use super::*;
    use crate::histogram::Times;

    fn report(columns: &[Column]) -> Report {
        let mut table = Table::new("speed", columns);
        let mut times = Times::new().unwrap();
        for nanoseconds in (1..=1000).map(|number| number * 1000) {
            times.record(nanoseconds);
        }
        let ours = Row::new("ours", vec![3.0, 20.0]).beside_all(&[("raw", "raw"), ("other", "other library")]);
        table.add(ours.with_times(&times));
        table.add(Row::new("raw", vec![2.5, 20.0]));
        table.add(Row::new("other library", vec![6.0, 20.0]).beside("raw", "raw"));
        Report { scenario: "example", tables: vec![table], notes: vec!["nothing else ran".to_owned()] }
    }

    #[test]
    fn text_shows_ratios_to_every_row_beside() {
        let expected = concat!(
            "speed\n",
            "                              p50 us ratio to\n",
            "               p50 us  bytes       raw  other\n",
            "ours                3     20      1.20   0.50\n",
            "raw              2.50     20\n",
            "other library       6     20      2.40\n",
            "note: nothing else ran\n",
        );
        assert_eq!(report(&[Column::compared("p50_us"), Column::plain("bytes")]).to_string(), expected);
    }

    #[test]
    fn distributions_follow_when_asked_for() {
        let expected = concat!(
            "speed\n",
            "               p50 us  bytes\n",
            "ours                3     20\n",
            "raw              2.50     20\n",
            "other library       6     20\n",
            "times in us that so many do not exceed; . marks up to 0.1 % of them, : 1 %, + 10 %, # more\n",
            "                                                                  1 us to 1000 us, logarithmic\n",
            "         50%     90%     99%   99.9%  99.99%   max\n",
            "ours  500.22  900.10  990.21  999.42    1000  1000  |.   . . ....::::::::::::+++++++++++++###|\n",
            "note: nothing else ran\n",
        );
        let report = report(&[Column::plain("p50_us"), Column::plain("bytes")]);
        assert_eq!(format!("{report:#}"), expected);
    }
}
