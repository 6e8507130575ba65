//! What a simulation has recorded.

use crate::error::SimulationError;
use scl::bytes::Bytes;
use scl::codec::{Codec, Protobuf};
use scl_record::format::SIMULATION_START;
use scl_record::recording::Recording;
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::time::Duration;
use tempfile::TempDir;

/// A simulation that is over: the messages of all `pub`, `pull` and `rep` gates, and what was printed.
#[derive(Debug)]
pub struct Simulated {
    /// Contains the recording.
    _folder: TempDir,
    recording: PathBuf,
    out: String,
    err: String,
    gates: HashMap<String, Gate>,
}

/// What a gate has sent or received.
#[derive(Debug)]
struct Gate {
    codec: String,
    messages: Vec<(Duration, Bytes)>,
}

impl Simulated {
    pub(crate) fn read(folder: TempDir, recording: PathBuf, out: String, err: String) -> Result<Self, SimulationError> {
        let unreadable = SimulationError::recording;
        let opened = Recording::open(std::slice::from_ref(&recording)).map_err(unreadable)?;
        let mut gates: HashMap<String, Gate> = HashMap::new();
        let mut messages = opened.messages();
        while let Some(message) = messages.read().map_err(unreadable)? {
            let channel = &messages.channels()[message.channel];
            let new = || Gate { codec: channel.metadata.codec.clone(), messages: Vec::new() };
            let at = Duration::from_nanos(message.sent_ns).saturating_sub(SIMULATION_START);
            gates.entry(channel.topic.name()).or_insert_with(new).messages.push((at, message.payload));
        }
        Ok(Self { _folder: folder, recording, out, err, gates })
    }

    /// The protobuf messages of a gate, in order, each with the time since the start at which it was sent. Empty if
    /// there were none. Requests to a `rep` gate are those of `valve.settings request`, and its replies those of
    /// `valve.settings reply`.
    ///
    /// # Errors
    ///
    /// Those of [`messages_in`](Self::messages_in).
    pub fn messages<T>(&self, gate: &str) -> Result<Vec<(Duration, T)>, SimulationError>
    where
        Protobuf: Codec<T>,
    {
        self.messages_in::<Protobuf, T>(gate)
    }

    /// [`messages`](Self::messages) of a gate with another codec: `messages_in::<scl::codec::Json,
    /// Level>("pump.level")`.
    ///
    /// # Errors
    ///
    /// [`SimulationError::OtherCodec`] if the gate has another one, and [`SimulationError::Undecodable`] if a message
    /// is not a `T`.
    pub fn messages_in<C: Codec<T>, T>(&self, gate: &str) -> Result<Vec<(Duration, T)>, SimulationError> {
        let Some(recorded) = self.gates.get(gate) else { return Ok(Vec::new()) };
        recorded.check_codec(gate, C::NAME)?;
        recorded.messages.iter().map(|message| decode::<C, T>(gate, message)).collect()
    }

    /// The last protobuf message of a gate, with the time since the start at which it was sent.
    ///
    /// # Errors
    ///
    /// Those of [`last_in`](Self::last_in).
    pub fn last<T>(&self, gate: &str) -> Result<(Duration, T), SimulationError>
    where
        Protobuf: Codec<T>,
    {
        self.last_in::<Protobuf, T>(gate)
    }

    /// [`last`](Self::last) of a gate with another codec.
    ///
    /// # Errors
    ///
    /// [`SimulationError::NoMessage`] if there was none, and those of [`messages_in`](Self::messages_in).
    pub fn last_in<C: Codec<T>, T>(&self, gate: &str) -> Result<(Duration, T), SimulationError> {
        let none = || {
            let mut others: Vec<String> = self.gates.keys().cloned().collect();
            others.sort();
            SimulationError::NoMessage { gate: gate.to_owned(), others }
        };
        let recorded = self.gates.get(gate).ok_or_else(none)?;
        recorded.check_codec(gate, C::NAME)?;
        recorded.messages.last().ok_or_else(none).and_then(|message| decode::<C, T>(gate, message))
    }

    /// What the programs have printed, each line with the name of its component.
    pub fn printed(&self) -> &str {
        &self.out
    }

    /// What `scl simulate` has said: which programs have ended, which faults have happened.
    pub fn log(&self) -> &str {
        &self.err
    }

    /// The recording, for `scl compare` and other tools. It is deleted with this value.
    pub fn recording(&self) -> &Path {
        &self.recording
    }
}

impl Gate {
    fn check_codec(&self, gate: &str, codec: &'static str) -> Result<(), SimulationError> {
        if self.codec == codec {
            return Ok(());
        }
        Err(SimulationError::OtherCodec { gate: gate.to_owned(), codec, recorded: self.codec.clone() })
    }
}

fn decode<C: Codec<T>, T>(gate: &str, (at, bytes): &(Duration, Bytes)) -> Result<(Duration, T), SimulationError> {
    let undecodable = |error| SimulationError::Undecodable { gate: gate.to_owned(), at: *at, error };
    Ok((*at, C::decode(bytes.clone()).map_err(undecodable)?))
}
