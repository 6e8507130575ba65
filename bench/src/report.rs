//! What was measured, as a table for people and as JSON for programs.

use crate::histogram::Times;
use serde_json::{Map, Value, json};
use std::fmt;

/// What one scenario measured.
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
    pub(crate) name: &'static str,
    /// Whether rows are divided by the row they stand beside.
    pub(crate) compared: bool,
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Row {
    name: String,
    beside: Option<String>,
    /// One a column.
    figures: Vec<f64>,
    distribution: Vec<(f64, f64)>,
}

impl Report {
    pub(crate) fn new(scenario: &'static str) -> Self {
        Self { scenario, tables: Vec::new(), notes: Vec::new() }
    }

    pub(crate) fn add(&mut self, table: Table) {
        self.tables.push(table);
    }

    pub(crate) fn note(&mut self, text: impl Into<String>) {
        self.notes.push(text.into());
    }

    /// One object: `scenario`, `tables` (each with `title` and `rows`) and `notes`.
    ///
    /// A row has its `name`, its figures by names that end in their unit (`p50_us`), and where there is something to
    /// compare with, its name (`beside`) and the `ratios` to its figures. Times also have their `distribution`, pairs
    /// of a part of all times and the microseconds that this part does not exceed.
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

    /// The ratio of a row to the one beside it, where the column has one.
    fn ratio(&self, row: &Row, column: usize) -> Option<f64> {
        let beside = self.rows.iter().find(|other| Some(&other.name) == row.beside.as_ref())?;
        let ratio = row.figures.get(column)? / beside.figures.get(column)?;
        (self.columns.get(column)?.compared && ratio.is_finite()).then_some(ratio)
    }

    fn to_json(&self) -> Value {
        let rows: Vec<Value> = self.rows.iter().map(|row| self.row_to_json(row)).collect();
        json!({ "title": self.title, "rows": rows })
    }

    fn row_to_json(&self, row: &Row) -> Value {
        let mut object = Map::new();
        object.insert("name".to_owned(), json!(row.name));
        let mut ratios = Map::new();
        for (index, (column, figure)) in self.columns.iter().zip(&row.figures).enumerate() {
            object.insert(column.name.to_owned(), json!(figure));
            if let Some(ratio) = self.ratio(row, index) {
                ratios.insert(column.name.to_owned(), json!(ratio));
            }
        }
        if let Some(beside) = &row.beside {
            object.insert("beside".to_owned(), json!(beside));
            object.insert("ratios".to_owned(), Value::Object(ratios));
        }
        if !row.distribution.is_empty() {
            object.insert("distribution".to_owned(), json!(row.distribution));
        }
        Value::Object(object)
    }
}

impl Column {
    /// A figure on its own.
    pub(crate) const fn plain(name: &'static str) -> Self {
        Self { name, compared: false }
    }

    /// A figure that is also given as a ratio.
    pub(crate) const fn compared(name: &'static str) -> Self {
        Self { name, compared: true }
    }

    fn heading(self) -> String {
        self.name.replace('_', " ")
    }
}

impl Row {
    pub(crate) fn new(name: impl Into<String>, figures: Vec<f64>) -> Self {
        Self { name: name.into(), beside: None, figures, distribution: Vec::new() }
    }

    /// Names the row that this one is compared with.
    pub(crate) fn beside(self, name: Option<&str>) -> Self {
        Self { beside: name.map(str::to_owned), ..self }
    }

    pub(crate) fn with_distribution(self, times: &Times) -> Self {
        Self { distribution: times.distribution(), ..self }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, table) in self.tables.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            write!(f, "{table}")?;
        }
        for note in &self.notes {
            writeln!(f, "note: {note}")?;
        }
        Ok(())
    }
}

impl fmt::Display for Table {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title)?;
        let width = self.rows.iter().map(|row| row.name.len()).max().unwrap_or_default();
        write!(f, "{:width$}", "")?;
        for column in &self.columns {
            write!(f, " {:>12}", column.heading())?;
        }
        let compared = self.columns.iter().filter(|column| column.compared);
        let headings: Vec<String> = compared.map(|column| format!("{} ratio", column.heading())).collect();
        for heading in &headings {
            write!(f, " {heading:>16}")?;
        }
        writeln!(f)?;
        for row in &self.rows {
            write!(f, "{:width$}", row.name)?;
            for figure in &row.figures {
                write!(f, " {:>12}", shortened(*figure))?;
            }
            for ratio in (0..self.columns.len()).filter_map(|column| self.ratio(row, column)) {
                write!(f, " {ratio:>16.2}")?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// Four digits or so, whatever the size.
fn shortened(figure: f64) -> String {
    let digits = if figure.fract() == 0.0 || figure.abs() >= 1000.0 { 0 } else { 2 };
    format!("{figure:.digits$}")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn report() -> Report {
        let mut table = Table::new("speed", &[Column::compared("p50_us"), Column::plain("bytes")]);
        table.add(Row::new("ours", vec![3.0, 20.0]).beside(Some("raw")));
        table.add(Row::new("raw", vec![2.5, 20.0]));
        let mut report = Report::new("example");
        report.add(table);
        report.note("nothing else ran");
        report
    }

    #[test]
    fn text_shows_ratios_beside_the_raw_part() {
        let expected = concat!(
            "speed\n",
            "           p50 us        bytes     p50 us ratio\n",
            "ours            3           20             1.20\n",
            "raw          2.50           20\n",
            "note: nothing else ran\n",
        );
        assert_eq!(report().to_string(), expected);
    }

    #[test]
    fn json_names_each_figure() {
        let rows = json!([
            { "name": "ours", "p50_us": 3.0, "bytes": 20.0, "beside": "raw", "ratios": { "p50_us": 1.2 } },
            { "name": "raw", "p50_us": 2.5, "bytes": 20.0 },
        ]);
        let expected = json!({
            "scenario": "example",
            "tables": [{ "title": "speed", "rows": rows }],
            "notes": ["nothing else ran"],
        });
        assert_eq!(report().to_json(), expected);
    }
}
