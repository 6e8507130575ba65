//! A running `scl record`, and the messages in its files.

use crate::rover::Rover;
use crate::system::{ChildGuard, SpawnGuarded, kill};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{BufRead, BufReader, Read};
use std::path::Path;
use std::process::{ChildStderr, Command, Stdio};

/// A running `scl record`; killed when dropped.
pub(super) struct Recorder {
    process: ChildGuard,
    log: BufReader<ChildStderr>,
}

impl Recorder {
    /// Starts recording into `flight.mcap`, and waits until this number of gates is connected.
    pub(super) fn start(rover: &Rover, gates: usize, arguments: &[&str]) -> Self {
        let mut recorder = Self::spawn(rover.scl(&[&["record", "-o", "flight.mcap"], arguments].concat()));
        recorder.wait_for(&match gates {
            0 => "waiting".to_owned(),
            _ => format!("connected to {gates} gates"),
        });
        recorder
    }

    /// Starts a command that records.
    pub(super) fn spawn(mut command: Command) -> Self {
        let mut process = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn_guarded();
        let log = BufReader::new(process.stderr.take().unwrap());
        Self { process, log }
    }

    /// Reads standard error up to a line that contains this.
    #[track_caller]
    pub(super) fn wait_for(&mut self, text: &str) -> String {
        let mut seen = String::new();
        loop {
            let mut line = String::new();
            self.log.read_line(&mut line).unwrap();
            assert_ne!(line, "", "no line with `{text}` in:\n{seen}");
            if line.contains(text) {
                return line;
            }
            seen += &line;
        }
    }

    pub(super) fn process_id(&self) -> u32 {
        self.process.id()
    }

    pub(super) fn signal(&self, signal: &str) {
        kill(signal, self.process_id());
    }

    /// Ends the recording as Ctrl-C does; standard output.
    #[track_caller]
    pub(super) fn stop(self) -> String {
        self.signal("-INT");
        let (code, out, err) = self.finish();
        assert_eq!(code, Some(0), "{err}");
        out
    }

    /// The same for `--format json`.
    #[track_caller]
    pub(super) fn stop_json(self) -> Value {
        let text = self.stop();
        serde_json::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"))
    }

    /// Waits for the end: exit code and the rest of both streams.
    pub(super) fn finish(mut self) -> (Option<i32>, String, String) {
        let (mut out, mut err) = (String::new(), String::new());
        self.log.read_to_string(&mut err).unwrap();
        self.process.stdout.take().unwrap().read_to_string(&mut out).unwrap();
        (self.process.wait().unwrap().code(), out, err)
    }
}

/// Recorded and lost messages of a gate in the JSON report.
pub(super) fn figures(report: &Value, gate: &str) -> (u64, u64) {
    let gates = report["gates"].as_array().unwrap();
    let found = gates.iter().find(|it| it["gate"] == gate).unwrap_or_else(|| panic!("no `{gate}` in {report}"));
    (found["recorded"].as_u64().unwrap(), found["lost"].as_u64().unwrap())
}

/// A message in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Message {
    pub(super) topic: String,
    pub(super) sequence: u32,
    pub(super) log_time: u64,
    pub(super) publish_time: u64,
    pub(super) data: Vec<u8>,
}

/// All messages of a file that may be cut off, in order.
pub(super) fn messages(path: &Path) -> Vec<Message> {
    let Ok(file) = File::open(path) else { return Vec::new() };
    let read = mcap::io::MessageReader::new(BufReader::new(file));
    let message = |message: mcap::Message<'static>| Message {
        topic: message.channel.topic.clone(),
        sequence: message.sequence,
        log_time: message.log_time,
        publish_time: message.publish_time,
        data: message.data.into_owned(),
    };
    read.map_while(Result::ok).map(message).collect()
}

/// The sequences of a topic's messages, from `first` on.
pub(super) fn sequences(path: &Path, topic: &str, first: u64) -> Vec<u64> {
    let of_topic = messages(path).into_iter().filter(|message| message.topic == topic);
    of_topic.map(|message| message.sequence.into()).skip_while(|sequence| *sequence < first).collect()
}

/// Number of messages by topic.
pub(super) fn counts(path: &Path) -> BTreeMap<String, usize> {
    let mut counts = BTreeMap::new();
    messages(path).into_iter().for_each(|message| *counts.entry(message.topic).or_default() += 1);
    counts
}

/// The index of a complete file.
pub(super) fn summary(path: &Path) -> mcap::Summary {
    let bytes = std::fs::read(path).unwrap();
    mcap::Summary::read(&bytes).unwrap().unwrap_or_else(|| panic!("`{}` has no index", path.display()))
}
