//! A report for people: values, and below them their ratios to those of other rows.

use super::distribution::distribution;
use super::ratio::Ratio;
use super::text_table::{TextTable, format_value};
use super::{Column, Report, Row, Table};
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

fn values(table: &Table) -> TextTable {
    let mut text = TextTable::new("", table.rows.iter().map(|row| row.name.clone()).collect());
    for (index, column) in table.columns.iter().enumerate() {
        let values = table.rows.iter().filter_map(|row| row.values.get(index));
        text.add(column.heading(), values.map(|value| format_value(*value)).collect());
    }
    text
}

/// One line per row and baseline; empty if no row is compared.
fn ratios(table: &Table) -> String {
    let pairs = |row| table.baselines(row).map(move |baseline| (row, baseline));
    let pairs: Vec<(&Row, &Row)> = table.rows.iter().flat_map(pairs).collect();
    if pairs.is_empty() {
        return String::new();
    }
    let names = pairs.iter().map(|(row, baseline)| format!("{} to {}", row.name, baseline.name)).collect();
    let mut text = TextTable::new("ratio", names);
    let ratios: Vec<Vec<(Column, Option<Ratio>)>> =
        pairs.iter().map(|(row, baseline)| table.ratios(row, baseline)).collect();
    for (index, column) in table.columns.iter().filter(|column| column.compared).enumerate() {
        let ratios: Vec<Option<Ratio>> =
            ratios.iter().map(|ratios| ratios.get(index).and_then(|(_, ratio)| *ratio)).collect();
        text.add(column.heading(), ratios.iter().map(|ratio| cell(ratio.map(|ratio| ratio.value))).collect());
        let quartiles: Vec<Option<[f64; 2]>> = ratios.iter().map(|ratio| ratio.and_then(|r| r.quartiles)).collect();
        if quartiles.iter().any(Option::is_some) {
            let range = |[first, third]: [f64; 2]| format!("{first:.2} to {third:.2}");
            text.add("quartiles", quartiles.into_iter().map(|q| q.map_or_else(String::new, range)).collect());
        }
    }
    text.to_string()
}

fn cell(ratio: Option<f64>) -> String {
    ratio.map_or_else(String::new, |ratio| format!("{ratio:.2}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::durations::Durations;

    fn report(columns: &[Column]) -> Report {
        let mut table = Table::new("speed", columns);
        let mut durations = Durations::new().unwrap();
        for nanoseconds in (1..=1000).map(|number| number * 1000) {
            durations.record(nanoseconds);
        }
        let ours = Row::new("ours", vec![3.0, 20.0]).with_baselines(&["raw", "other library"]);
        table.add(ours.with_durations(&durations).with_rounds(&[3.0, 3.5]));
        table.add(Row::new("raw", vec![2.5, 20.0]).with_rounds(&[2.5, 2.5]));
        table.add(Row::new("other library", vec![6.0, 20.0]).with_baselines(&["raw"]));
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
