//! The records with which every file of a recording begins, so that each file is self-contained.

use super::file::RecordingFile;
use super::write_error::WriteError;
use crate::format::PLAN;
use bytes::Bytes;
use scl_observe::ObservedGate;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

/// A file that is added to recordings, for example the topology.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct AttachedFile {
    /// Its name in the recording, see [`crate::format`].
    pub name: &'static str,
    /// Its content.
    pub data: Vec<u8>,
}

/// What is known about the system; grows during the recording.
#[derive(Debug)]
pub(crate) struct Contents {
    pub(crate) system: String,
    pub(crate) attached: Vec<AttachedFile>,
    /// The plans of all components that were seen, as JSON.
    pub(crate) plan: Bytes,
    /// What changes during the recording, as JSON by the name of its attachment.
    pub(crate) latest: BTreeMap<&'static str, Bytes>,
    /// The gates by their numbers.
    pub(crate) gates: Vec<ObservedGate>,
}

impl Contents {
    /// Starts a recording with everything known so far. If that fails, the file is removed.
    pub(crate) fn start_file(&self, path: PathBuf, file: File) -> Result<RecordingFile, WriteError> {
        self.begin(path.clone(), file).inspect_err(|_| {
            // Never remove a device or pipe.
            if path.is_file() {
                let _removed = fs::remove_file(&path);
            }
        })
    }

    fn begin(&self, path: PathBuf, file: File) -> Result<RecordingFile, WriteError> {
        let mut recording = RecordingFile::start(path, file, &self.system)?;
        for attached in &self.attached {
            recording.attach(attached.name, "application/yaml", &attached.data, now_ns())?;
        }
        attach_plan(&mut recording, &self.plan)?;
        for (name, latest) in &self.latest {
            attach_latest(&mut recording, name, latest)?;
        }
        for (number, gate) in self.gates.iter().enumerate() {
            recording.add_gate(number, gate)?;
        }
        // From now on, readers can open it.
        recording.flush()?;
        Ok(recording)
    }
}

/// Adds the plans to a recording; the last ones in a file count.
pub(crate) fn attach_plan(recording: &mut RecordingFile, plan: &[u8]) -> Result<(), WriteError> {
    recording.attach(PLAN, "application/json", plan, now_ns())
}

/// Adds what has changed to a recording.
pub(crate) fn attach_latest(recording: &mut RecordingFile, name: &str, latest: &[u8]) -> Result<(), WriteError> {
    recording.attach(name, "application/json", latest, now_ns())
}

/// Returns the current time in nanoseconds since 1970 by `CLOCK_REALTIME`, the clock of the taps.
pub(crate) fn now_ns() -> u64 {
    let elapsed = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or(Duration::ZERO);
    scl_text::duration::nanoseconds(elapsed)
}
