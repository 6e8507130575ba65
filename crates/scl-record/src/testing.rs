//! Recordings for tests: what the recorder writes, made without a system.
#![allow(clippy::unwrap_used, missing_docs, reason = "only tests use it")]

use crate::format::{ChannelMetadata, Encoding, PLAN, PROFILE, Part, Topic, Totals};
use mcap::records::{MessageHeader, Metadata};
use mcap::{Attachment, Compression, WriteOptions, Writer};
use scl_plan::{GateKind, SystemPlan};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// One message: topic, milliseconds since the beginning, payload.
pub type Sample<'a> = (&'a str, u64, &'a str);

/// Milliseconds since 1970 at the beginning of all recordings.
pub const BEGINNING: u64 = 1_700_000_000_000;

/// A recording in memory.
pub struct Recorder {
    writer: Writer<Cursor<Vec<u8>>>,
    channels: BTreeMap<String, u16>,
    plan: Option<SystemPlan>,
    sequence: u32,
}

impl Default for Recorder {
    fn default() -> Self {
        Self::new()
    }
}

impl Recorder {
    pub fn new() -> Self {
        Self::with_profile(PROFILE)
    }

    pub fn with_profile(profile: &str) -> Self {
        Self::with_options(WriteOptions::new().profile(profile).compression(Some(Compression::Lz4)))
    }

    pub fn with_compression(compression: Option<Compression>) -> Self {
        Self::with_options(WriteOptions::new().profile(PROFILE).compression(compression))
    }

    fn with_options(options: WriteOptions) -> Self {
        let options = options.chunk_size(Some(1 << 20)).disable_seeking(true);
        let writer = options.create(Cursor::new(Vec::new())).unwrap();
        Self { writer, channels: BTreeMap::new(), plan: None, sequence: 0 }
    }

    pub fn attach_plan(mut self, plan: &SystemPlan) -> Self {
        let data = plan.to_json().into_bytes();
        let (name, media_type) = (PLAN.to_owned(), "application/json".to_owned());
        self.writer
            .attach(&Attachment { log_time: 0, create_time: 0, name, media_type, data: Cow::Owned(data) })
            .unwrap();
        self
    }

    /// Takes types, codecs and contracts from a plan, which is not attached.
    pub fn of_plan(mut self, plan: &SystemPlan) -> Self {
        self.plan = Some(plan.clone());
        self
    }

    /// Adds messages in JSON, unless the plan says otherwise.
    pub fn messages(self, samples: &[Sample<'_>]) -> Self {
        samples.iter().fold(self, |recorder, sample| recorder.message_of_type(*sample, "json", "rover.Measurement"))
    }

    /// Adds messages in JSON that the recorder received at this time, in milliseconds since the beginning.
    pub fn messages_received(mut self, received: u64, samples: &[Sample<'_>]) -> Self {
        for &(topic, at, payload) in samples {
            let channel_id = self.channel(topic, "json", "rover.Measurement");
            self.write_received(channel_id, at, received, payload.as_bytes());
        }
        self
    }

    pub fn message_of_type(mut self, (topic, at, payload): Sample<'_>, codec: &str, type_name: &str) -> Self {
        let channel_id = self.channel(topic, codec, type_name);
        self.write(channel_id, at, payload.as_bytes());
        self
    }

    /// Skips a number, like a recorder that has lost a message.
    pub fn lose_message(mut self) -> Self {
        self.sequence += 1;
        self
    }

    pub fn restart_numbers(mut self) -> Self {
        self.sequence = 0;
        self
    }

    pub fn end_chunk(mut self) -> Self {
        self.writer.flush().unwrap();
        self
    }

    /// Adds a message that SCL did not record: its topic, message encoding and encoding of the schema.
    pub fn other_message(mut self, (topic, encoding, schema): (&str, &str, &str), payload: &[u8]) -> Self {
        let schema = self.writer.add_schema("other/Type", schema, b"float64 x").unwrap();
        let channel_id = self.writer.add_channel(schema, topic, encoding, &BTreeMap::new()).unwrap();
        self.write(channel_id, 0, payload);
        self
    }

    /// Adds a private record of another program.
    pub fn private_record(mut self, opcode: u8, data: &[u8]) -> Self {
        self.writer.write_private_record(opcode, data, Default::default()).unwrap();
        self
    }

    pub fn totals(mut self, totals: &Totals) -> Self {
        let name = Totals::NAME.to_owned();
        self.writer.write_metadata(&Metadata { name, metadata: totals.to_map() }).unwrap();
        self
    }

    pub fn finish(mut self) -> Vec<u8> {
        self.writer.finish().unwrap();
        self.writer.into_inner().into_inner()
    }

    pub fn write_to(self, folder: &Path, name: &str) -> PathBuf {
        write_file(folder, name, &self.finish())
    }

    fn channel(&mut self, topic: &str, codec: &str, type_name: &str) -> u16 {
        if let Some(id) = self.channels.get(topic) {
            return *id;
        }
        let parsed = Topic::parse(topic).unwrap();
        let metadata = ChannelMetadata {
            kind: if parsed.part == Part::Message { GateKind::Pub } else { GateKind::Rep },
            type_name: Some(type_name.to_owned()),
            codec: codec.to_owned(),
            contract: "aaaaaaaa".to_owned(),
            peers: Vec::new(),
        };
        let metadata = self.planned(&parsed).unwrap_or(metadata);
        let encoding = Encoding::new(&metadata.codec, metadata.type_name.as_deref(), None);
        let schema = self.writer.add_schema(encoding.schema_name, encoding.schema_encoding, &encoding.schema).unwrap();
        let id = self.writer.add_channel(schema, topic, &encoding.message, &metadata.to_map()).unwrap();
        self.channels.insert(topic.to_owned(), id);
        id
    }

    fn planned(&self, topic: &Topic) -> Option<ChannelMetadata> {
        let gate = self.plan.as_ref()?.component(&topic.component).ok()?.gate(&topic.gate)?;
        let type_name = topic.part.type_name(&gate.payload).map(str::to_owned);
        let (codec, contract) = (gate.codec.clone(), gate.contract.clone());
        Some(ChannelMetadata { kind: gate.kind, type_name, codec, contract, peers: Vec::new() })
    }

    fn write(&mut self, channel_id: u16, at: u64, payload: &[u8]) {
        self.write_received(channel_id, at, at, payload);
    }

    fn write_received(&mut self, channel_id: u16, at: u64, received: u64, payload: &[u8]) {
        let [publish_time, log_time] = [at, received].map(|time| (BEGINNING + time) * 1_000_000);
        let header = MessageHeader { channel_id, sequence: self.sequence, log_time: log_time + 1, publish_time };
        self.sequence += 1;
        self.writer.write_to_known_channel(&header, payload).unwrap();
    }
}

pub fn write_file(folder: &Path, name: &str, content: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, content).unwrap();
    path
}
