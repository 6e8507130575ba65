//! What a comparison has found.

use crate::format::Topic;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// What a comparison has found.
#[derive(Debug, Clone, Default)]
pub struct CompareReport {
    /// By topic, in alphabetical order.
    pub gates: Vec<GateComparison>,
    /// Notes on both recordings: topics that were left out, steps of the clock, gaps.
    pub notes: Vec<String>,
}

/// The comparison of one topic.
#[derive(Debug, Clone)]
pub struct GateComparison {
    /// Name of the topic: `controller.actuator`, or for a `rep` gate `controller.commands request`.
    pub name: String,
    /// Messages that have a counterpart.
    pub paired: u64,
    /// Of those, the ones that differ.
    pub different: u64,
    /// Messages that only the first recording has.
    pub missing: u64,
    /// Messages that only the second recording has.
    pub additional: u64,
    /// The first differences.
    pub differences: Vec<Difference>,
}

/// One message that is not the same in both recordings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    pub kind: DifferenceKind,
    /// Index of the message in its topic, from 0, in the first recording; for an additional message, in the second.
    pub index: u64,
    /// Number of messages in a row that are missing or additional; otherwise 1.
    pub count: u64,
    /// Time since the beginning of that recording.
    pub time: Duration,
    /// Time of the last of the `count` messages.
    pub until: Duration,
    /// The first field that differs; `.` for the whole message, empty unless `kind` is `Different`.
    pub field: String,
    /// The values in both recordings.
    pub values: [Option<String>; 2],
}

/// How a message differs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DifferenceKind {
    Different,
    Missing,
    Additional,
}

impl CompareReport {
    /// Whether both recordings have the same messages.
    pub fn is_equal(&self) -> bool {
        self.gates.iter().all(GateComparison::is_equal)
    }

    /// Returns the report as text: one line per topic, and one per difference.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for gate in &self.gates {
            if gate.is_equal() {
                let _ = writeln!(text, "{}: {} equal", gate.name, messages(gate.paired));
                continue;
            }
            let GateComparison { name, paired, different, missing, additional, differences } = gate;
            let _ = writeln!(
                text,
                "{name}: {different} of {} different, {missing} missing, {additional} additional",
                messages(*paired)
            );
            differences.iter().for_each(|difference| {
                let _ = writeln!(text, "  {}", difference.to_text());
            });
            let more = different + missing + additional - differences.iter().map(|it| it.count).sum::<u64>();
            if more > 0 {
                let _ = writeln!(text, "  and {more} more");
            }
        }
        text
    }

    /// Returns the report as one JSON object.
    pub fn to_json(&self) -> Value {
        let gates: Vec<_> = self.gates.iter().map(GateComparison::to_json).collect();
        json!({"equal": self.is_equal(), "gates": gates})
    }
}

impl GateComparison {
    pub(super) fn new(topic: &Topic) -> Self {
        Self { name: topic.name(), paired: 0, different: 0, missing: 0, additional: 0, differences: Vec::new() }
    }

    /// Number of messages in both recordings; a pair counts once.
    pub fn messages(&self) -> u64 {
        self.paired + self.missing + self.additional
    }

    /// Whether both recordings have the same messages.
    pub fn is_equal(&self) -> bool {
        self.different + self.missing + self.additional == 0
    }

    fn to_json(&self) -> Value {
        let differences = self.differences.iter().map(|difference| {
            let kind = match difference.kind {
                DifferenceKind::Different => "different",
                DifferenceKind::Missing => "missing",
                DifferenceKind::Additional => "additional",
            };
            json!({
                "kind": kind,
                "index": difference.index,
                "count": difference.count,
                "seconds": difference.time.as_secs_f64(),
                "field": Some(&difference.field).filter(|field| !field.is_empty()),
                "first": difference.values[0],
                "second": difference.values[1],
            })
        });
        json!({
            "gate": self.name,
            "equal": self.is_equal(),
            "paired": self.paired,
            "different": self.different,
            "missing": self.missing,
            "additional": self.additional,
            "differences": differences.collect::<Vec<_>>(),
        })
    }
}

impl Difference {
    fn to_text(&self) -> String {
        let [first, second] = self.values.each_ref().map(|value| value.as_deref().unwrap_or("nothing"));
        let place = format!("message {} at {:.3} s", self.index, self.time.as_secs_f64());
        match (self.kind, self.field.as_str()) {
            (DifferenceKind::Different, ".") => format!("{place}: {first} -> {second}"),
            (DifferenceKind::Different, field) => format!("{place}, {field}: {first} -> {second}"),
            (kind, _) if self.count > 1 => {
                let word = if kind == DifferenceKind::Missing { "missing" } else { "additional" };
                let (last, until) = (self.index + self.count - 1, self.until.as_secs_f64());
                format!(
                    "{} messages, {} at {:.3} s to {last} at {until:.3} s, are {word}",
                    self.count,
                    self.index,
                    self.time.as_secs_f64()
                )
            }
            (DifferenceKind::Missing, _) => format!("{place} is missing: {first}"),
            (DifferenceKind::Additional, _) => format!("{place} is additional: {second}"),
        }
    }
}

fn messages(number: u64) -> String {
    format!("{number} message{}", if number == 1 { "" } else { "s" })
}
