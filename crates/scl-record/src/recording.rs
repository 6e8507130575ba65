//! Reading recordings: one file or several in a row, from start to end, in bounded memory.
//!
//! A file is read linearly and needs no index, so a file that was cut off at any byte yields everything before that
//! byte, and a note. [`Recording::open`] walks over the file without reading its messages, to learn what must be known
//! beforehand: the plan, the duration, the totals.

mod channel;
pub(crate) mod chunk;
mod clock;
mod files;
mod index;
mod messages;
mod overview;
mod records;
mod survey;

pub(crate) use channel::type_and_codec;
pub use channel::{OtherTopic, RecordedChannel};
pub(crate) use clock::Clock;
pub use files::find_files;
pub use index::{Index, MessagesFrom, TimedMessage};
pub use messages::{Messages, RecordedMessage};
pub use overview::Attachment;
pub(crate) use records::Records;
pub use survey::{Survey, SurveyedTopic};

use crate::format::{GateTotals, MISSED, MissedGate, PARAMETERS, PLAN, Totals};
use overview::Overview;
use scl_plan::SystemPlan;
use scl_terminal::Problem;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A recording: the files that one `scl record` wrote, in order.
#[derive(Debug)]
pub struct Recording {
    files: Vec<(PathBuf, Overview)>,
}

impl Recording {
    /// Opens the files of one recording, which are read one after the other.
    ///
    /// # Errors
    /// A file cannot be read, is empty, or is not an MCAP file.
    pub fn open(files: &[PathBuf]) -> Result<Self, Problem> {
        let files = files.iter().map(|path| Ok((path.clone(), Overview::read(path)?)));
        let mut files: Vec<_> = files.collect::<Result<_, Problem>>()?;
        // Parts that a shell has sorted by name (`part10` before `part2`) are put in order.
        if files.iter().all(|(_, overview)| overview.times.is_some()) {
            files.sort_by_key(|(_, overview)| overview.times);
        }
        Ok(Self { files })
    }

    /// The messages, in the order of the files.
    pub fn messages(&self) -> Messages {
        Messages::new(self.paths().map(Path::to_owned).collect())
    }

    /// Reads all messages once, and returns what the recording contains.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn survey(&self) -> Result<Survey, Problem> {
        Survey::take(self)
    }

    /// The plans of the components that were recorded; `None` if the recording has none.
    ///
    /// # Errors
    /// The plan cannot be read.
    pub fn plan(&self) -> Result<Option<SystemPlan>, Problem> {
        let Some((path, plan)) = self.attachment(PLAN) else { return Ok(None) };
        let text = std::str::from_utf8(&plan.data).map_err(|error| error.to_string());
        let plan = text.and_then(|text| SystemPlan::from_json(text).map_err(|error| error.to_string()));
        let unreadable = |reason| {
            Problem::new(format!("the plan in the recording cannot be read: {reason}"))
                .at(path.display().to_string())
                .help("name the topology file with `--topology`")
        };
        plan.map(Some).map_err(unreadable)
    }

    /// The last values of the parameters of each component, by name; empty if the recording has none.
    pub fn parameters(&self) -> BTreeMap<String, BTreeMap<String, String>> {
        let values = self.attachment(PARAMETERS).map(|(_, values)| serde_json::from_slice(&values.data));
        values.and_then(Result::ok).unwrap_or_default()
    }

    /// The gates that have missed messages during the recording, sorted by name; empty if there are none, or the
    /// recording does not tell.
    pub fn missed(&self) -> Vec<MissedGate> {
        let missed = self.attachment(MISSED).map(|(_, missed)| serde_json::from_slice(&missed.data));
        missed.and_then(Result::ok).unwrap_or_default()
    }

    /// Wall-clock times of the first and the last message, in nanoseconds since 1970; `None` without messages.
    pub fn times(&self) -> Option<(u64, u64)> {
        let times = || self.files.iter().filter_map(|(_, overview)| overview.times);
        Some((times().map(|(first, _)| first).min()?, times().map(|(_, last)| last).max()?))
    }

    /// The time between the first and the last message.
    pub fn duration(&self) -> Duration {
        self.times().map_or(Duration::ZERO, |(first, last)| Duration::from_nanos(last - first))
    }

    /// Messages recorded and lost per gate, summed over the files; a file that was cut off has no totals.
    pub fn totals(&self) -> BTreeMap<String, GateTotals> {
        let mut sum = BTreeMap::<String, GateTotals>::new();
        for (gate, totals) in self
            .files
            .iter()
            .filter_map(|(_, overview)| Totals::from_map(overview.metadata.get(Totals::NAME)?))
            .flat_map(|one| one.gates)
        {
            let gate = sum.entry(gate).or_default();
            gate.recorded += totals.recorded;
            gate.lost += totals.lost;
            gate.latched += totals.latched;
        }
        sum
    }

    /// What a reader of the messages should know: files that were cut off, messages that the recorder lost.
    pub fn notes(&self) -> Vec<String> {
        let cut = self.files.iter().filter_map(|(path, overview)| {
            let ending = overview.ending.as_deref()?;
            Some(format!("`{}` {ending}; reading what is there", path.display()))
        });
        let lost = self.totals().into_iter().filter(|(_, totals)| totals.lost > 0);
        let lost = lost.map(|(gate, totals)| format!("the recorder lost {} messages of `{gate}`", totals.lost));
        cut.chain(lost).collect()
    }

    /// Its files, in order.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.files.iter().map(|(path, _)| path.as_path())
    }

    /// Path of the first file, for messages.
    pub fn name(&self) -> String {
        self.paths().next().map(|path| path.display().to_string()).unwrap_or_default()
    }

    /// The files attached to the recording, the newest last.
    pub fn attachments(&self) -> impl Iterator<Item = &Attachment> {
        self.files.iter().flat_map(|(_, overview)| &overview.attachments)
    }

    fn attachment(&self, name: &str) -> Option<(&Path, &Attachment)> {
        let files = self.files.iter().rev();
        let mut found = files.flat_map(|(path, overview)| {
            overview.attachments.iter().rev().map(move |attachment| (path.as_path(), attachment))
        });
        found.find(|(_, attachment)| attachment.name == name)
    }
}

#[cfg(test)]
mod tests;
