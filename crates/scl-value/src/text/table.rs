//! Messages as rows of a table, for CSV.

use crate::base64::to_base64;
use crate::path::FieldPath;
use crate::value::{Value, to_json};

/// The columns of a table of messages, one per field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Table {
    columns: Vec<FieldPath>,
}

impl Table {
    /// A table with these fields as columns.
    pub fn new(columns: Vec<FieldPath>) -> Self {
        Self { columns }
    }

    /// A table with the fields of a message as columns, for messages whose type is not known.
    pub fn of(first: &Value) -> Self {
        Self { columns: FieldPath::leaves(first) }
    }

    /// The paths of the fields; the message itself is `value`.
    pub fn header(&self) -> Vec<String> {
        let name = |path: &FieldPath| if path.is_empty() { "value".to_owned() } else { path.to_string() };
        self.columns.iter().map(name).collect()
    }

    /// Whether every part of a message has a column.
    pub fn has_all_of(&self, message: &Value) -> bool {
        let leaves = FieldPath::leaves(message);
        leaves.iter().all(|leaf| self.columns.iter().any(|column| leaf.starts_with(column)))
    }

    /// A message as a row: empty for fields that it does not have, lists and maps as JSON.
    pub fn row(&self, message: &Value) -> Vec<String> {
        self.columns.iter().map(|path| path.find(message).map_or_else(String::new, cell)).collect()
    }
}

fn cell(value: &Value) -> String {
    match value.meaning() {
        Value::Null => String::new(),
        Value::Text(text) => text.clone(),
        Value::Float(number) if number.is_nan() => "NaN".to_owned(),
        Value::Float(number) if number.is_infinite() => if *number > 0.0 { "inf" } else { "-inf" }.to_owned(),
        Value::Bytes(bytes) => to_base64(bytes),
        other => to_json(other),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read_yaml;

    #[test]
    fn a_row_has_a_cell_per_field() {
        let first = read_yaml("{a: 1, pose: {x: 1.5, y: .nan}, list: [1, {b: 2}], text: 'a,b'}").unwrap();
        let table = Table::of(&first);
        assert_eq!(table.header(), ["a", "pose.x", "pose.y", "list", "text"]);
        assert_eq!(table.row(&first), ["1", "1.5", "NaN", r#"[1,{"b":2}]"#, "a,b"]);
        let other = read_yaml("{pose: {x: 2}, more: 1}").unwrap();
        assert_eq!(table.row(&other), ["", "2", "", "", ""]);
        assert_eq!(
            (Table::of(&Value::Int(3)).header(), Table::of(&Value::Int(3)).row(&Value::Int(3))),
            (vec!["value".to_owned()], vec!["3".to_owned()])
        );
    }
}
