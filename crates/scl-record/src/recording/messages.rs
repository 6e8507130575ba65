//! The messages of a recording, one by one. Messages of topics that SCL did not record are counted and left out.

use super::channel::{OtherTopic, RecordedChannel, RecordedSchema};
use super::chunk;
use super::records::{RecordHeader, Records};
use crate::parse::{COMPRESSIONS, parse};
use bytes::Bytes;
use mcap::McapError;
use mcap::records::{Channel, MessageHeader, Record, op};
use scl_terminal::{Problem, escape};
use std::collections::{HashMap, VecDeque};
use std::path::{Path, PathBuf};

/// One message, request or reply.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RecordedMessage {
    /// Index in [`Messages::channels`].
    pub channel: usize,
    /// See [`crate::format::sequence`].
    pub sequence: u32,
    /// When the gate sent it, in nanoseconds since 1970.
    pub sent_ns: u64,
    /// When the recorder received it.
    pub received_ns: u64,
    pub payload: Bytes,
}

/// Reads the messages of a recording in the order of its files. Keeps no more than one chunk in memory.
#[derive(Debug, Default)]
pub struct Messages {
    files: VecDeque<PathBuf>,
    records: Option<Records>,
    known: Known,
    /// Where the record with the latest message begins in its file.
    offset: u64,
    channels: Vec<RecordedChannel>,
    others: Vec<OtherTopic>,
    ready: VecDeque<RecordedMessage>,
}

/// Schemas and channels of the current file, by their ids.
#[derive(Debug, Clone, Default)]
pub(super) struct Known {
    schemas: HashMap<u16, RecordedSchema>,
    channel_ids: HashMap<u16, Origin>,
}

/// Whether SCL or another program recorded a channel, with the index in `channels` or `others`.
#[derive(Debug, Clone, Copy)]
enum Origin {
    Scl(usize),
    Other(usize),
}

/// Why a record cannot be used.
enum Fault {
    /// The record is damaged; others may be sound.
    Damaged(String),
    /// The record cannot be read, although it may be sound.
    Unusable(String),
}

impl Messages {
    pub(super) fn new(files: VecDeque<PathBuf>) -> Self {
        Self { files, ..Self::default() }
    }

    /// The messages of a file from this byte on, of which this is known, and these channels of the whole recording.
    pub(super) fn resume(
        path: &Path,
        offset: Option<u64>,
        known: Known,
        channels: Vec<RecordedChannel>,
    ) -> Result<Self, Problem> {
        let mut records = Records::open(path)?;
        if let Some(offset) = offset {
            records.go_to(offset)?;
        }
        Ok(Self { records: Some(records), known, channels, ..Self::default() })
    }

    /// What is known at the end of a file.
    pub(super) fn into_known(self) -> (Known, Vec<RecordedChannel>) {
        (self.known, self.channels)
    }

    /// Where the record with the latest message begins in its file.
    pub(super) fn offset(&self) -> u64 {
        self.offset
    }

    /// Where the record begins that the next message is in, or one before it.
    pub(super) fn next_offset(&self) -> u64 {
        match &self.records {
            Some(records) if self.ready.is_empty() => records.position(),
            _ => self.offset,
        }
    }

    /// The next message; `None` at the end.
    ///
    /// # Errors
    /// A file cannot be read or is damaged.
    pub fn read(&mut self) -> Result<Option<RecordedMessage>, Problem> {
        loop {
            if let Some(message) = self.ready.pop_front() {
                return Ok(Some(message));
            }
            let Some(mut records) = self.records.take() else {
                let Some(path) = self.files.pop_front() else { return Ok(None) };
                self.known = Known::default();
                self.records = Some(Records::open(&path)?);
                continue;
            };
            if let Some(header) = records.next()?
                && header.opcode != op::DATA_END
            {
                self.offset = header.offset;
                self.read_record(&mut records, header)?;
                self.records = Some(records);
            }
        }
    }

    /// The channels seen so far.
    pub fn channels(&self) -> &[RecordedChannel] {
        &self.channels
    }

    /// The topics seen so far that SCL did not record.
    pub fn others(&self) -> &[OtherTopic] {
        &self.others
    }

    fn read_record(&mut self, records: &mut Records, header: RecordHeader) -> Result<(), Problem> {
        let mut taken = Ok(());
        if header.opcode == op::CHUNK {
            let content = records.content(u64::MAX)?;
            let read = chunk::read(&content, header.length, |record| {
                if taken.is_ok() {
                    taken = self.take(record);
                }
            });
            if !header.is_cut {
                taken = taken.and_then(|()| read.map_err(Fault::from));
            }
        } else if !header.is_cut && matches!(header.opcode, op::SCHEMA | op::CHANNEL | op::MESSAGE) {
            let content = records.content(u64::MAX)?;
            let record = parse(header.opcode, &content).ok_or_else(|| Fault::damaged("unreadable record"));
            taken = record.and_then(|record| self.take(record));
        }
        taken.map_err(|fault| fault.at(records, header))
    }

    fn take(&mut self, record: Record<'_>) -> Result<(), Fault> {
        match record {
            Record::Schema { header, data } => {
                let (id, data) = (header.id, Bytes::copy_from_slice(&data));
                self.known.schemas.insert(id, RecordedSchema { name: header.name, encoding: header.encoding, data });
            }
            Record::Channel(channel) => {
                // Chunks and files of a recording repeat the channels.
                let origin = self.origin(&channel);
                self.known.channel_ids.insert(channel.id, origin);
            }
            Record::Message { header, data } => {
                let MessageHeader { channel_id, sequence, log_time, publish_time } = header;
                let known = self.known.channel_ids.get(&channel_id);
                let channel = match *known.ok_or_else(|| Fault::damaged("a message belongs to no channel"))? {
                    Origin::Scl(channel) => channel,
                    Origin::Other(index) => {
                        self.others[index].messages += 1;
                        return Ok(());
                    }
                };
                let payload = Bytes::copy_from_slice(&data);
                let message =
                    RecordedMessage { channel, sequence, sent_ns: publish_time, received_ns: log_time, payload };
                self.ready.push_back(message);
            }
            _ => {}
        }
        Ok(())
    }

    fn origin(&mut self, channel: &Channel) -> Origin {
        let schema = self.known.schemas.get(&channel.schema_id).cloned().unwrap_or_default();
        let schema_name = schema.name.clone();
        match RecordedChannel::new(channel, schema) {
            Ok(recorded) => Origin::Scl(index_of(&mut self.channels, |known| *known == recorded, || recorded.clone())),
            Err(reason) => {
                let is_known = |other: &OtherTopic| other.topic == channel.topic;
                let new = || OtherTopic::new(channel, &schema_name, reason);
                Origin::Other(index_of(&mut self.others, is_known, new))
            }
        }
    }
}

/// Returns the index of the first element for which `is_it` returns true; adds `new()` if there is none.
fn index_of<T>(all: &mut Vec<T>, is_it: impl Fn(&T) -> bool, new: impl FnOnce() -> T) -> usize {
    all.iter().position(is_it).unwrap_or_else(|| {
        all.push(new());
        all.len() - 1
    })
}

impl From<McapError> for Fault {
    fn from(error: McapError) -> Self {
        match error {
            McapError::UnsupportedCompression(name) => {
                let name = escape(&name);
                Self::Unusable(format!("its chunks are compressed with `{name}`; scl reads {COMPRESSIONS}"))
            }
            McapError::BadChunkCrc { .. } => Self::damaged("a chunk has a wrong checksum"),
            error => Self::damaged(error),
        }
    }
}

impl Fault {
    fn damaged(reason: impl std::fmt::Display) -> Self {
        Self::Damaged(format!("the recording is damaged: {reason}"))
    }

    fn at(self, records: &Records, header: RecordHeader) -> Problem {
        match self {
            Self::Unusable(reason) => records.problem(header.offset, reason),
            Self::Damaged(reason) => {
                let path = records.path().display();
                let help = format!("`scl recover {path} -o FILE` writes the undamaged messages into a new file");
                records.problem(header.offset, reason).help(help)
            }
        }
    }
}
