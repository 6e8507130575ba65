//! A report for people: values, and below them their ratios to those of other rows.

use super::distribution::distribution;
use super::text_table::{format_value, text_table};
use super::{Column, Report, Table};
use std::fmt;

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, table) in self.tables.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{}\n{}{}", table.title, values(table), ratios(table))?;
            if f.alternate() {
                f.write_str(&distribution(table))?;
            }
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}

fn values(table: &Table) -> String {
    let mut text = text_table("", table.columns.iter().map(|column| column.heading()));
    for row in &table.rows {
        text.row(std::iter::once(row.name.clone()).chain(row.values.iter().map(|value| format_value(*value))));
    }
    text.fit(usize::MAX)
}

/// One line per row and baseline; empty if no row is compared.
fn ratios(table: &Table) -> String {
    let lines = table.rows.iter().flat_map(|row| {
        table
            .baselines(row)
            .map(move |baseline| (format!("{} to {}", row.name, baseline.name), table.ratios(row, baseline)))
    });
    let lines: Vec<(String, Vec<_>)> = lines.collect();
    if lines.is_empty() {
        return String::new();
    }
    let has_quartiles = |column: Column| {
        let mut ratios = lines.iter().flat_map(|(_, ratios)| ratios);
        ratios.any(|(other, ratio)| *other == column && ratio.is_some_and(|ratio| ratio.quartiles.is_some()))
    };
    let compared = table.columns.iter().filter(|column| column.compared);
    let headings = compared.flat_map(|column| {
        let quartiles = has_quartiles(*column).then(|| "quartiles".to_owned());
        std::iter::once(column.heading()).chain(quartiles)
    });
    let mut text = text_table("ratio", headings);
    for (name, ratios) in &lines {
        let cells = ratios.iter().flat_map(|(column, ratio)| {
            let value = ratio.map_or_else(String::new, |ratio| format!("{:.2}", ratio.value));
            let range = |[first, third]: [f64; 2]| format!("{first:.2} to {third:.2}");
            let quartiles = ratio.and_then(|ratio| ratio.quartiles).map_or_else(String::new, range);
            std::iter::once(value).chain(has_quartiles(*column).then_some(quartiles))
        });
        text.row(std::iter::once(name.clone()).chain(cells));
    }
    text.fit(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::super::Row;
    use super::*;
    use crate::durations::Durations;

    fn report(columns: &[Column]) -> Report {
        let mut table = Table::new("speed", columns);
        let mut durations = Durations::new().unwrap();
        for nanoseconds in (1..=1000).map(|number| number * 1000) {
            durations.record(nanoseconds);
        }
        let ours = Row::new("ours", vec![3.0, 20.0]).with_baselines(&["raw", "other library"]);
        table.rows.push(ours.with_durations(&durations).with_rounds(&[3.0, 3.5]));
        table.rows.push(Row::new("raw", vec![2.5, 20.0]).with_rounds(&[2.5, 2.5]));
        table.rows.push(Row::new("other library", vec![6.0, 20.0]).with_baselines(&["raw"]));
        Report { benchmark: "example", tables: vec![table], notes: vec!["idle machine".to_owned()] }
    }

    #[test]
    fn ratios_name_both_rows() {
        let expected = concat!(
            "speed\n",
            "               p50 us  bytes\n",
            "ours                3     20\n",
            "raw              2.50     20\n",
            "other library       6     20\n",
            "ratio                  p50 us     quartiles\n",
            "ours to raw              1.40  1.20 to 1.40\n",
            "ours to other library    0.50\n",
            "other library to raw     2.40\n",
            "note: idle machine\n",
        );
        assert_eq!(report(&[Column::compared("p50_us"), Column::plain("bytes")]).to_string(), expected);
    }

    #[test]
    fn distributions_are_printed_on_request() {
        let expected = concat!(
            "speed\n",
            "               p50 us  bytes\n",
            "ours                3     20\n",
            "raw              2.50     20\n",
            "other library       6     20\n",
            "quantiles in us; bins from 1 to 1000 us: . up to 0.1 % of all, : 1 %, + 10 %, # more\n",
            "         50%     90%     99%   99.9%  99.99%   max\n",
            "ours  500.22  900.10  990.21  999.42    1000  1000  |...::::++++++###|\n",
            "note: idle machine\n",
        );
        let mut report = report(&[Column::plain("p50_us"), Column::plain("bytes")]);
        for row in &mut report.tables[0].rows {
            row.baselines.clear();
        }
        assert_eq!(format!("{report:#}"), expected);
    }
}
