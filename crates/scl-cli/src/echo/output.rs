//! How `scl echo` prints messages: as YAML documents, JSON lines or rows of CSV.

use super::watched::Watched;
use super::{MessageFormat, selected};
use scl::tap::{Observation, ObservedKind};
use scl_terminal::{escape, output_is_terminal, print_err, print_out_bytes, timestamp};
use scl_value::{FieldPath, Table, Value, to_json, to_yaml};
use std::time::{Duration, SystemTime};

/// Prints messages in one of the formats.
pub(super) struct Output<'a> {
    format: MessageFormat,
    fields: &'a [FieldPath],
    /// Whether messages of several gates have to be told apart.
    several: bool,
    /// Whether there are requests and replies.
    exchanges: bool,
    /// Number of types of messages.
    types: usize,
    /// The columns of CSV that are known from the types of all gates.
    columns: Option<Vec<FieldPath>>,
    /// The columns, once the header is printed.
    table: Option<Table>,
    /// Whether a message had a field without a column.
    left_out: bool,
}

impl<'a> Output<'a> {
    pub(super) fn new(format: MessageFormat, fields: &'a [FieldPath], several: bool) -> Self {
        let (exchanges, types, columns, table, left_out) = Default::default();
        Self { format, fields, several, exchanges, types, columns, table, left_out }
    }

    /// Adapts the output to all known gates; must be called before the first message of each. Once the CSV header is
    /// printed, the columns no longer change.
    pub(super) fn learn(&mut self, gates: &[Watched]) {
        self.types = gates.iter().flat_map(Watched::types).count();
        if self.table.is_none() {
            self.several |= gates.len() > 1;
            self.exchanges = gates.iter().any(Watched::exchanges);
            self.columns = if self.fields.is_empty() { known_columns(gates) } else { Some(self.fields.to_vec()) };
        }
    }

    /// Whether messages of several types are shown.
    pub(super) fn shows_several_types(&self) -> bool {
        self.types > 1
    }

    /// Prints a message.
    pub(super) fn print(&mut self, gate: &Watched, seen: &Observation, message: &Value) {
        let text = match self.format {
            MessageFormat::Yaml => self.document(gate, seen, &selected(message, self.fields)).into_bytes(),
            MessageFormat::Json => line(gate, seen, selected(message, self.fields)).into_bytes(),
            MessageFormat::Csv => self.row(gate, seen, message),
        };
        print_out_bytes(&text);
    }

    fn document(&self, gate: &Watched, seen: &Observation, shown: &Value) -> String {
        // The YAML library escapes control characters, but not bidirectional formatting characters.
        let text: String = to_yaml(shown).lines().map(|line| format!("{}\n", escape(line))).collect();
        let is_nested = matches!(shown, Value::Map(_) | Value::List(_) | Value::Opaque(_));
        if !self.several && !self.exchanges {
            // The scalar values of a single field are printed one per line, without separators.
            return if is_nested || self.fields.len() != 1 { format!("---\n{text}") } else { text };
        }
        let what = match seen.kind {
            ObservedKind::Message => seen.sequence.to_string(),
            kind => format!("{} of call {}", word(kind), seen.call_id),
        };
        format!("--- # {} {what}, {}\n{text}", gate.name, timestamp(time_of(seen)))
    }

    fn row(&mut self, gate: &Watched, seen: &Observation, message: &Value) -> Vec<u8> {
        let mut rows = Vec::new();
        if self.table.is_none() {
            let table = self.columns.take().map_or_else(|| Table::of(message), Table::new);
            // No field has a name that begins with `@`.
            let cells = self.own_cells(["@time", "@sequence", "@gate", "@kind", "@call"]);
            rows.extend(csv_row(cells.map(str::to_owned).chain(table.header())));
            self.table = Some(table);
        }
        let Some(table) = &self.table else { return rows };
        if !self.left_out && self.fields.is_empty() && !table.has_all_of(message) {
            self.left_out = true;
            print_err(
                "note: some messages have fields that the first one does not have; choose columns with `--field`\n",
            );
        }
        let time = format!("{}.{:09}", seen.sent_ns / 1_000_000_000, seen.sent_ns % 1_000_000_000);
        let (sequence, call) = (seen.sequence.to_string(), seen.call_id.to_string());
        let cells = self.own_cells([&time, &sequence, &gate.name, word(seen.kind), &call]);
        let cells = cells.map(str::to_owned).chain(table.row(message));
        rows.extend(match output_is_terminal() {
            true => csv_row(cells.map(|cell| escape(&cell).into_owned())),
            false => csv_row(cells),
        });
        rows
    }

    /// Returns the cells before those of the fields: time and sequence, and gate, kind and call if they are shown.
    fn own_cells<'t>(&self, [time, sequence, gate, kind, call]: [&'t str; 5]) -> impl Iterator<Item = &'t str> {
        let exchange = self.exchanges.then_some([kind, call]).into_iter().flatten();
        [time, sequence].into_iter().chain(self.several.then_some(gate)).chain(exchange)
    }
}

fn csv_row(cells: impl Iterator<Item = String>) -> Vec<u8> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    // Writing one record into memory cannot fail.
    let _written = writer.write_record(cells.map(String::into_bytes));
    writer.into_inner().unwrap_or_default()
}

/// A message as JSON on one line.
fn line(gate: &Watched, seen: &Observation, shown: Value) -> String {
    let mut fields = vec![
        ("gate", gate.name.as_str().into()),
        ("time", exact_time(seen).into()),
        ("sequence", seen.sequence.into()),
        ("kind", word(seen.kind).into()),
    ];
    if seen.kind != ObservedKind::Message {
        fields.push(("call", Value::from(seen.call_id).with_large_numbers_as_texts()));
    }
    if seen.latched {
        fields.push(("latched", true.into()));
    }
    fields.push(("message", gate.for_json(seen, shown)));
    format!("{}\n", to_json(&Value::fields(fields)))
}

/// The columns of all types of the gates, if all are known.
fn known_columns(gates: &[Watched]) -> Option<Vec<FieldPath>> {
    let mut columns: Vec<FieldPath> = Vec::new();
    for messages in gates.iter().flat_map(Watched::types) {
        for column in messages.columns()? {
            if !columns.contains(&column) {
                columns.push(column);
            }
        }
    }
    Some(columns)
}

fn word(kind: ObservedKind) -> &'static str {
    match kind {
        ObservedKind::Message => "message",
        ObservedKind::Request => "request",
        ObservedKind::Reply => "reply",
    }
}

fn time_of(seen: &Observation) -> SystemTime {
    SystemTime::UNIX_EPOCH + Duration::from_nanos(seen.sent_ns)
}

/// The time of sending with nanoseconds: `2026-11-22T00:05:09.250123456Z`.
fn exact_time(seen: &Observation) -> String {
    let text = timestamp(time_of(seen));
    let seconds = text.split('.').next().unwrap_or(&text);
    format!("{seconds}.{:09}Z", seen.sent_ns % 1_000_000_000)
}
