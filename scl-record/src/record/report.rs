//! What a recording has come to, for people and programs.

use super::file::WrittenFile;
use crate::format::Totals;
use scl_terminal::{Problem, escape};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// The result of [`record`](super::record()).
#[derive(Debug)]
pub struct Report {
    /// All gates, also of files that were deleted by `keep`.
    pub totals: Totals,
    pub duration: Duration,
    /// The files that exist.
    pub files: Vec<WrittenFile>,
    /// Number of older files that were deleted.
    pub deleted: usize,
    /// Why recording ended early.
    pub problem: Option<Problem>,
}

impl Report {
    /// Messages of all gates.
    pub fn recorded(&self) -> u64 {
        self.totals.gates.values().map(|gate| gate.recorded).sum()
    }

    /// A table of the gates, and the files.
    pub fn text(&self) -> String {
        let width = self.totals.gates.keys().map(|name| name.len()).max().unwrap_or(0).max("gate".len());
        let mut text = format!("{:width$}  {:>12}  {:>10}\n", "gate", "recorded", "lost");
        for (name, gate) in &self.totals.gates {
            let _ = writeln!(text, "{name:width$}  {:>12}  {:>10}", gate.recorded, gate.lost);
        }
        let files = match &self.files[..] {
            [] => "no file".to_owned(),
            [only] => escape(&only.path.to_string_lossy()).into_owned(),
            [first, .., last] => {
                format!("{} to {}", escape(&first.path.to_string_lossy()), escape(&last.path.to_string_lossy()))
            }
        };
        let bytes = self.files.iter().map(|file| file.bytes).sum();
        let _ = writeln!(text, "{files}: {}, {:.1} s", size(bytes), self.duration.as_secs_f64());
        if self.deleted > 0 {
            let _ = writeln!(text, "{} older files deleted (`--keep`)", self.deleted);
        }
        text
    }

    /// The same as one JSON value.
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

/// `1.2 MiB`
pub(crate) fn size(bytes: u64) -> String {
    const UNITS: [&str; 4] = ["KiB", "MiB", "GiB", "TiB"];
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    let mut value = bytes as f64 / 1024.0;
    let mut units = UNITS.iter();
    let mut unit = units.next().unwrap_or(&"");
    while value >= 1024.0
        && let Some(next) = units.next()
    {
        (value, unit) = (value / 1024.0, next);
    }
    format!("{value:.1} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::GateTotals;
    use std::collections::BTreeMap;

    #[test]
    fn sizes_have_a_unit() {
        for (bytes, expected) in
            [(0, "0 B"), (1023, "1023 B"), (1536, "1.5 KiB"), (1 << 30, "1.0 GiB"), (u64::MAX, "16777216.0 TiB")]
        {
            assert_eq!(size(bytes), expected);
        }
    }

    #[test]
    fn the_text_names_gates_and_files() {
        let gates = BTreeMap::from([("sensor.measurements".to_owned(), GateTotals { recorded: 5000, lost: 2 })]);
        let totals = Totals { system: "rover".to_owned(), gates };
        let file = WrittenFile { path: "flight.mcap".into(), bytes: 2048, totals: totals.clone() };
        let report = Report { totals, duration: Duration::from_secs(5), files: vec![file], deleted: 0, problem: None };
        expect_test::expect![[r#"
            gate                     recorded        lost
            sensor.measurements          5000           2
            flight.mcap: 2.0 KiB, 5.0 s
        "#]]
        .assert_eq(&report.text());
    }
}
