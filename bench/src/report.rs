//! The results of a benchmark, as tables for people and as JSON for programs.

mod distribution;
mod ratio;
mod text;
mod text_table;

use crate::cores::Cores;
use crate::durations::Durations;
use ratio::{Ratio, ratio};
use serde_json::{Map, Value, json};

/// The results of one benchmark.
///
/// `{}` prints tables; `{:#}` also prints the distribution of the durations below each table.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Report {
    benchmark: &'static str,
    pub(crate) tables: Vec<Table>,
    notes: Vec<String>,
}

/// Rows that were measured in one run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    title: String,
    columns: Vec<Column>,
    pub(crate) rows: Vec<Row>,
}

/// A column of values. Its name is the key in JSON, ends with the unit, and is the heading if printed as text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Column {
    name: &'static str,
    /// Whether rows are compared with their baselines by this value.
    compared: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    name: String,
    /// The names of the rows it is compared with.
    baselines: Vec<String>,
    /// One per column.
    values: Vec<f64>,
    /// The value of the first compared column in each round, if it was measured in rounds.
    rounds: Vec<f64>,
    durations: Option<Durations>,
}

impl Report {
    pub(crate) fn new(benchmark: &'static str) -> Self {
        let mut report = Self { benchmark, tables: Vec::new(), notes: Vec::new() };
        if cfg!(debug_assertions) {
            report.note("this program was built without optimisation; build it with `--release`");
        }
        report
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// Adds a note that explains the ratios of rows measured in rounds.
    pub(crate) fn note_rounds(&mut self) {
        self.note("ratios with quartiles are medians of the ratios within each round of the run");
    }

    /// Adds a note about where the processes ran.
    pub(crate) fn with_cores(mut self, cores: Cores) -> Self {
        self.notes.extend(cores.note().map(str::to_owned));
        self
    }

    /// One object: `benchmark`, `tables` (each with `title` and `rows`) and `notes`.
    ///
    /// A row has its `name` and its values under names that end with their unit (`p50_us`). `ratios`, if any, maps the
    /// name of each baseline to the ratios of the row's values to the baseline's; a ratio from several rounds also has
    /// its quartiles (`p50_us_quartiles`). `distribution`, if any, has pairs of a fraction of all durations and the
    /// microseconds that this fraction does not exceed.
    pub(crate) fn to_json(&self) -> Value {
        let tables: Vec<Value> = self.tables.iter().map(Table::to_json).collect();
        json!({ "benchmark": self.benchmark, "tables": tables, "notes": self.notes })
    }
}

impl Table {
    pub(crate) fn new(title: impl Into<String>, columns: &[Column]) -> Self {
        Self { title: title.into(), columns: columns.to_vec(), rows: Vec::new() }
    }

    /// The baselines of a row, without those that were not measured.
    fn baselines<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = &'a Row> {
        row.baselines.iter().filter_map(|name| self.rows.iter().find(|other| other.name == *name))
    }

    /// The ratios of a row to a baseline, one per compared column.
    fn ratios(&self, row: &Row, baseline: &Row) -> Vec<(Column, Option<Ratio>)> {
        let compared = self.columns.iter().enumerate().filter(|(_, column)| column.compared);
        let ratio_of = |(position, (index, column)): (usize, (usize, &Column))| {
            let [value, base] = [row, baseline].map(|row| row.values.get(index).copied().unwrap_or(f64::NAN));
            let rounds = [row, baseline].map(|row| if position == 0 { &row.rounds[..] } else { &[] });
            (*column, ratio(value, base, rounds))
        };
        compared.enumerate().map(ratio_of).collect()
    }

    fn to_json(&self) -> Value {
        let rows: Vec<Value> = self.rows.iter().map(|row| self.row_to_json(row)).collect();
        json!({ "title": self.title, "rows": rows })
    }

    fn row_to_json(&self, row: &Row) -> Value {
        let mut object = Map::new();
        object.insert("name".to_owned(), json!(row.name));
        for (column, value) in self.columns.iter().zip(&row.values) {
            object.insert(column.name.to_owned(), json!(value));
        }
        let ratios: Map<String, Value> = self
            .baselines(row)
            .map(|baseline| (baseline.name.clone(), ratios_to_json(&self.ratios(row, baseline))))
            .collect();
        if !ratios.is_empty() {
            object.insert("ratios".to_owned(), Value::Object(ratios));
        }
        if let Some(durations) = &row.durations {
            object.insert("distribution".to_owned(), json!(durations.cumulative()));
        }
        Value::Object(object)
    }
}

fn ratios_to_json(ratios: &[(Column, Option<Ratio>)]) -> Value {
    let mut object = Map::new();
    for (column, ratio) in ratios {
        let Some(ratio) = ratio else { continue };
        object.insert(column.name.to_owned(), json!(ratio.value));
        if let Some(quartiles) = ratio.quartiles {
            object.insert(format!("{}_quartiles", column.name), json!(quartiles));
        }
    }
    Value::Object(object)
}

impl Column {
    /// A column that is not compared.
    pub(crate) const fn plain(name: &'static str) -> Self {
        Self { name, compared: false }
    }

    /// A column by which rows are compared with their baselines.
    pub(crate) const fn compared(name: &'static str) -> Self {
        Self { name, compared: true }
    }

    fn heading(self) -> String {
        self.name.replace('_', " ")
    }
}

impl Row {
    pub(crate) fn new(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self { name: name.into(), baselines: Vec::new(), values, rounds: Vec::new(), durations: None }
    }

    /// Adds rows to compare this one with. Rows that are not in the table are ignored.
    pub(crate) fn with_baselines(mut self, names: &[impl AsRef<str>]) -> Self {
        self.baselines.extend(names.iter().map(|name| name.as_ref().to_owned()));
        self
    }

    /// Sets the value of the first compared column in each round.
    pub(crate) fn with_rounds(self, rounds: &[f64]) -> Self {
        Self { rounds: rounds.to_vec(), ..self }
    }

    pub(crate) fn with_durations(self, durations: &Durations) -> Self {
        Self { durations: Some(durations.clone()), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_names_every_value_and_baseline() {
        let mut table = Table::new("speed", &[Column::compared("p50_us"), Column::plain("bytes")]);
        table.rows.push(Row::new("ours", vec![3.0, 20.0]).with_baselines(&["raw", "not measured"]));
        table.rows.push(Row::new("raw", vec![2.5, 20.0]));
        table.rows.push(Row::new("rounds", vec![2.0, 20.0]).with_baselines(&["same rounds"]).with_rounds(&[2.0]));
        table.rows.push(Row::new("same rounds", vec![2.0, 20.0]).with_rounds(&[1.0]));
        let report = Report { benchmark: "example", tables: vec![table], notes: vec!["idle machine".to_owned()] };
        let rows = json!([
            { "name": "ours", "p50_us": 3.0, "bytes": 20.0, "ratios": { "raw": { "p50_us": 1.2 } } },
            { "name": "raw", "p50_us": 2.5, "bytes": 20.0 },
            {
                "name": "rounds",
                "p50_us": 2.0,
                "bytes": 20.0,
                "ratios": { "same rounds": { "p50_us": 2.0, "p50_us_quartiles": [2.0, 2.0] } },
            },
            { "name": "same rounds", "p50_us": 2.0, "bytes": 20.0 },
        ]);
        let expected = json!({
            "benchmark": "example",
            "tables": [{ "title": "speed", "rows": rows }],
            "notes": ["idle machine"],
        });
        assert_eq!(report.to_json(), expected);
    }
}
