//! What was measured, as a table for people and as JSON for programs.

mod grid;
mod spread;
mod text;

use crate::histogram::Times;
use serde_json::{Map, Value, json};

/// What one scenario measured.
///
/// Printed with `{}` it is tables; with `{:#}` each table of times is followed by how they are distributed.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    scenario: &'static str,
    tables: Vec<Table>,
    notes: Vec<String>,
}

/// Rows measured in one run.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Table {
    title: String,
    columns: Vec<Column>,
    rows: Vec<Row>,
}

/// A figure: its name in JSON, its unit included, and above a column of text; both from `p50_us`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Column {
    name: &'static str,
    /// Whether rows are divided by the rows they stand beside.
    compared: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    name: String,
    beside: Vec<Beside>,
    /// One a column.
    figures: Vec<f64>,
    times: Option<Times>,
}

/// Another row that a row is compared with, and the word for it above the ratios.
#[derive(Debug, Clone, PartialEq)]
struct Beside {
    label: &'static str,
    row: String,
}

/// Labels and names of the rows to compare with, as constants.
pub(crate) type Others = &'static [(&'static str, &'static str)];

impl Report {
    pub(crate) fn new(scenario: &'static str) -> Self {
        let mut report = Self { scenario, tables: Vec::new(), notes: Vec::new() };
        if cfg!(debug_assertions) {
            report.note("this program was built without optimisation: build it with `--release` for figures");
        }
        report
    }

    pub(crate) fn add(&mut self, table: Table) {
        self.tables.push(table);
    }

    /// Says where the processes ran.
    pub fn on(mut self, cores: crate::Cores) -> Self {
        self.notes.extend(cores.in_words().map(str::to_owned));
        self
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// One object: `scenario`, `tables` (each with `title` and `rows`) and `notes`.
    ///
    /// A row has its `name`, its figures by names that end in their unit (`p50_us`), and where there is something to
    /// compare with, `ratios`: by the name of each other row, the ratios of this row's figures to that row's. Times
    /// also have their `distribution`, pairs of a part of all times and the microseconds that it does not exceed.
    pub fn to_json(&self) -> Value {
        let tables: Vec<Value> = self.tables.iter().map(Table::to_json).collect();
        json!({ "scenario": self.scenario, "tables": tables, "notes": self.notes })
    }
}

impl Table {
    pub(crate) fn new(title: impl Into<String>, columns: &[Column]) -> Self {
        Self { title: title.into(), columns: columns.to_vec(), rows: Vec::new() }
    }

    pub(crate) fn add(&mut self, row: Row) {
        self.rows.push(row);
    }

    /// The rows that a row stands beside. What was not measured this time is left out.
    fn others<'a>(&'a self, row: &'a Row) -> impl Iterator<Item = (&'static str, &'a Row)> {
        let find = |beside: &Beside| self.rows.iter().find(|other| other.name == beside.row);
        row.beside.iter().filter_map(move |beside| Some((beside.label, find(beside)?)))
    }

    /// The ratio of a row to another one, where the column has one.
    fn ratio(&self, row: &Row, other: &Row, column: usize) -> Option<f64> {
        let ratio = row.figures.get(column)? / other.figures.get(column)?;
        (self.columns.get(column)?.compared && ratio.is_finite()).then_some(ratio)
    }

    fn to_json(&self) -> Value {
        let rows: Vec<Value> = self.rows.iter().map(|row| self.row_to_json(row)).collect();
        json!({ "title": self.title, "rows": rows })
    }

    fn row_to_json(&self, row: &Row) -> Value {
        let mut object = Map::new();
        object.insert("name".to_owned(), json!(row.name));
        for (column, figure) in self.columns.iter().zip(&row.figures) {
            object.insert(column.name.to_owned(), json!(figure));
        }
        let ratios: Map<String, Value> =
            self.others(row).map(|(_, other)| (other.name.clone(), self.ratios_to_json(row, other))).collect();
        if !ratios.is_empty() {
            object.insert("ratios".to_owned(), Value::Object(ratios));
        }
        if let Some(times) = &row.times {
            object.insert("distribution".to_owned(), json!(times.distribution()));
        }
        Value::Object(object)
    }

    fn ratios_to_json(&self, row: &Row, other: &Row) -> Value {
        let ratios = self.columns.iter().enumerate().filter_map(|(index, column)| {
            let ratio = self.ratio(row, other, index)?;
            Some((column.name.to_owned(), json!(ratio)))
        });
        Value::Object(ratios.collect())
    }
}

impl Column {
    /// A figure on its own.
    pub(crate) const fn plain(name: &'static str) -> Self {
        Self { name, compared: false }
    }

    /// A figure that is also given as ratios.
    pub(crate) const fn compared(name: &'static str) -> Self {
        Self { name, compared: true }
    }

    fn heading(self) -> String {
        self.name.replace('_', " ")
    }
}

impl Row {
    pub(crate) fn new(name: impl Into<String>, figures: Vec<f64>) -> Self {
        Self { name: name.into(), beside: Vec::new(), figures, times: None }
    }

    /// Names a row that this one is compared with.
    pub(crate) fn beside(mut self, label: &'static str, row: impl Into<String>) -> Self {
        self.beside.push(Beside { label, row: row.into() });
        self
    }

    pub(crate) fn beside_all(self, others: Others) -> Self {
        others.iter().fold(self, |row, (label, other)| row.beside(label, *other))
    }

    pub(crate) fn with_times(self, times: &Times) -> Self {
        Self { times: Some(times.clone()), ..self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_names_each_figure_and_what_it_is_compared_with() {
        let mut table = Table::new("speed", &[Column::compared("p50_us"), Column::plain("bytes")]);
        table.add(Row::new("ours", vec![3.0, 20.0]).beside_all(&[("raw", "raw"), ("other", "not measured")]));
        table.add(Row::new("raw", vec![2.5, 20.0]));
        let report = Report { scenario: "example", tables: vec![table], notes: vec!["nothing else ran".to_owned()] };
        let rows = json!([
            { "name": "ours", "p50_us": 3.0, "bytes": 20.0, "ratios": { "raw": { "p50_us": 1.2 } } },
            { "name": "raw", "p50_us": 2.5, "bytes": 20.0 },
        ]);
        let expected = json!({
            "scenario": "example",
            "tables": [{ "title": "speed", "rows": rows }],
            "notes": ["nothing else ran"],
        });
        assert_eq!(report.to_json(), expected);
    }
}
