//! What a simulation reports to the process that has started it.

use scl_conductor::Fault;
use serde_json::{Value, json};
use std::path::Path;
use std::{fs, io};

/// How a simulation has ended.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(super) struct Report {
    /// What was expected and did not happen, or which component failed; empty if all went well.
    pub(super) failures: Vec<String>,
    /// The faults that happened: their numbers and what they were.
    pub(super) faults: Vec<(usize, String)>,
}

impl Report {
    pub(super) fn new(failures: Vec<String>, faults: &[Fault]) -> Self {
        Self { failures, faults: faults.iter().map(|fault| (fault.number, fault.to_string())).collect() }
    }

    pub(super) fn write(&self, file: &Path) -> io::Result<()> {
        let faults = self.faults.iter().map(|(number, text)| json!({"number": number, "text": text}));
        let report = json!({"failures": self.failures, "faults": faults.collect::<Vec<_>>()});
        fs::write(file, report.to_string())
    }

    /// Reads a report; `None` if the simulation did not get so far.
    pub(super) fn read(file: &Path) -> Option<Self> {
        let report: Value = serde_json::from_str(&fs::read_to_string(file).ok()?).ok()?;
        let failures = report["failures"].as_array()?.iter().map(|text| text.as_str().map(str::to_owned));
        let faults = report["faults"]
            .as_array()?
            .iter()
            .map(|fault| Some((usize::try_from(fault["number"].as_u64()?).ok()?, fault["text"].as_str()?.to_owned())));
        Some(Self { failures: failures.collect::<Option<_>>()?, faults: faults.collect::<Option<_>>()? })
    }
}
