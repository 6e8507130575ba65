//! The result of a recording, as text and as JSON.

use super::file::WrittenFile;
use crate::format::Totals;
use scl_terminal::{Align, Problem, Table, bytes_text, escape};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// The result of [`record`](super::record()).
#[derive(Debug)]
pub struct Report {
    /// Totals of all gates, including messages in files that `keep` deleted.
    pub totals: Totals,
    pub duration: Duration,
    /// The files that were written and not deleted.
    pub files: Vec<WrittenFile>,
    /// Number of older files that were deleted.
    pub deleted: usize,
    /// Why recording ended early.
    pub problem: Option<Problem>,
}

impl Report {
    /// Number of recorded messages of all gates.
    pub fn recorded(&self) -> u64 {
        self.totals.gates.values().map(|gate| gate.recorded).sum()
    }

    /// Returns a table of the gates, and a line about the files.
    pub fn text(&self) -> String {
        let mut table = Table::new([("GATE", Align::Left), ("RECORDED", Align::Right), ("LOST", Align::Right)]);
        for (name, gate) in &self.totals.gates {
            table.row([name, &gate.recorded.to_string(), &gate.lost.to_string()]);
        }
        let mut text = table.text();
        let files = match &self.files[..] {
            [] => "no file".to_owned(),
            [only] => escape(&only.path.to_string_lossy()).into_owned(),
            [first, .., last] => {
                format!("{} to {}", escape(&first.path.to_string_lossy()), escape(&last.path.to_string_lossy()))
            }
        };
        let bytes: u64 = self.files.iter().map(|file| file.bytes).sum();
        let _ = writeln!(text, "{files}: {}, {:.1} s", bytes_text(bytes as f64), self.duration.as_secs_f64());
        if self.deleted > 0 {
            let _ = writeln!(text, "{} older files deleted (`--keep`)", self.deleted);
        }
        text
    }

    /// Returns the report as one JSON value.
    pub fn json(&self) -> Value {
        let gates = self
            .totals
            .gates
            .iter()
            .map(|(name, gate)| json!({"gate": name, "recorded": gate.recorded, "lost": gate.lost}));
        let files = self.files.iter().map(|file| {
            let messages: u64 = file.totals.gates.values().map(|gate| gate.recorded).sum();
            json!({"path": file.path.to_string_lossy(), "bytes": file.bytes, "messages": messages})
        });
        json!({
            "system": self.totals.system,
            "seconds": self.duration.as_secs_f64(),
            "gates": gates.collect::<Vec<_>>(),
            "files": files.collect::<Vec<_>>(),
            "deleted": self.deleted,
            "complete": self.problem.is_none(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::GateTotals;
    use std::collections::BTreeMap;

    #[test]
    fn the_text_names_gates_and_files() {
        let gates =
            BTreeMap::from([("sensor.measurements".to_owned(), GateTotals { recorded: 5000, lost: 2, latched: 0 })]);
        let totals = Totals { system: "rover".to_owned(), gates };
        let file = WrittenFile { path: "flight.mcap".into(), bytes: 2048, totals: totals.clone() };
        let report = Report { totals, duration: Duration::from_secs(5), files: vec![file], deleted: 0, problem: None };
        expect_test::expect![[r#"
            GATE                 RECORDED  LOST
            sensor.measurements      5000     2
            flight.mcap: 2.00 KiB, 5.0 s
        "#]]
        .assert_eq(&report.text());
    }
}
