//! One recording on disk: an MCAP file that is readable at any moment up to its last flush.

use super::disk_room::DiskRoom;
use super::gate::{Message, NewChannel, channels};
use super::write_error::WriteError;
use crate::format::{GateTotals, PROFILE, Part, Totals};
use mcap::records::{MessageHeader, Metadata};
use mcap::write::NoSeek;
use mcap::{Attachment, Compression, McapError, WriteOptions, Writer};
use scl_observe::ObservedGate;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Uncompressed size of a chunk, at which it is compressed and written.
const CHUNK: u64 = 1 << 20;

/// Upper bounds of what the index contains besides the schemas and channels, in bytes.
const INDEX_PER_CHUNK: u64 = 128;
const INDEX_PER_CHUNK_AND_CHANNEL: u64 = 16;
const INDEX_PER_CHANNEL: u64 = 256;
const INDEX_REST: u64 = 16 << 10;

/// Upper bound of what a message needs besides its bytes: its record and its entry of the chunk's index.
const PER_MESSAGE: u64 = 64;

/// A recording that is being written.
pub(crate) struct RecordingFile {
    path: PathBuf,
    file: Arc<File>,
    writer: Writer<NoSeek<BufWriter<Counted>>>,
    written: Arc<AtomicU64>,
    room: DiskRoom,
    /// By gate and part.
    channels: BTreeMap<(usize, Part), u16>,
    system: String,
    /// Names and totals of the gates by their numbers.
    gates: BTreeMap<usize, (String, GateTotals)>,
    /// Size up to which everything has been handed to the operating system in complete records.
    flushed: u64,
    /// Upper bound of the bytes in the open chunk.
    pending: u64,
    /// Upper bound of the size of the index.
    index: u64,
}

/// A finished recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct WrittenFile {
    pub path: PathBuf,
    pub bytes: u64,
    pub totals: Totals,
}

impl RecordingFile {
    /// Starts a recording in an empty file.
    pub(crate) fn start(path: PathBuf, file: File, system: &str) -> Result<Self, WriteError> {
        let file = Arc::new(file);
        let written = Arc::new(AtomicU64::new(0));
        let mut room = DiskRoom::default();
        room.ensure(&file, INDEX_REST).map_err(WriteError::Full)?;
        let output = Counted { file: Arc::clone(&file), written: Arc::clone(&written) };
        let writer = options().create(NoSeek::new(BufWriter::with_capacity(BUFFER, output)))?;
        Ok(Self {
            path,
            file,
            writer,
            written,
            room,
            channels: BTreeMap::new(),
            system: system.to_owned(),
            gates: BTreeMap::new(),
            flushed: 0,
            pending: 0,
            index: INDEX_REST,
        })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Bytes on disk and in the open chunk, without the index.
    pub(crate) fn size(&self) -> u64 {
        self.written.load(Ordering::Relaxed) + self.pending
    }

    /// Adds a file, for example the topology.
    pub(crate) fn attach(&mut self, name: &str, media_type: &str, data: &[u8], now_ns: u64) -> Result<(), WriteError> {
        self.ensure_room(data.len() as u64 + 2 * (INDEX_PER_CHUNK + name.len() as u64))?;
        self.index += INDEX_PER_CHUNK + name.len() as u64;
        self.writer.attach(&Attachment {
            log_time: now_ns,
            create_time: now_ns,
            name: name.to_owned(),
            media_type: media_type.to_owned(),
            data: data.into(),
        })?;
        self.pending = 0;
        Ok(())
    }

    /// Adds the channels of a gate, unless the file has them already.
    pub(crate) fn add_gate(&mut self, number: usize, gate: &ObservedGate) -> Result<(), WriteError> {
        for NewChannel { part, topic, encoding, metadata } in channels(gate) {
            // A channel's record is also copied into the index, so it takes `size` twice.
            let texts: usize = metadata.iter().map(|(key, value)| key.len() + value.len()).sum();
            let size =
                (encoding.schema.len() + encoding.schema_name.len() + topic.len() + texts) as u64 + INDEX_PER_CHANNEL;
            self.ensure_room(2 * size)?;
            self.index += size;
            self.pending += size;
            let schema = self.writer.add_schema(encoding.schema_name, encoding.schema_encoding, &encoding.schema)?;
            let channel = self.writer.add_channel(schema, &topic, &encoding.message, &metadata)?;
            self.channels.insert((number, part), channel);
        }
        self.gates.entry(number).or_insert_with(|| (gate.name(), GateTotals::default()));
        Ok(())
    }

    /// Adds a message of a gate that has been added.
    pub(crate) fn write(&mut self, message: &Message) -> Result<(), WriteError> {
        let size = message.payload.len() as u64 + PER_MESSAGE;
        self.ensure_room(size)?;
        let Some(&channel_id) = self.channels.get(&(message.gate, message.part)) else {
            return Err(McapError::UnknownChannel(message.sequence, 0).into());
        };
        let header = MessageHeader {
            channel_id,
            sequence: message.sequence,
            log_time: message.received_ns,
            publish_time: message.sent_ns,
        };
        self.writer.write_to_known_channel(&header, &message.payload)?;
        self.pending += size;
        if let Some((_, totals)) = self.gates.get_mut(&message.gate) {
            totals.recorded += 1;
            totals.latched += u64::from(message.latched);
        }
        if self.pending >= CHUNK {
            self.flush()?;
        }
        Ok(())
    }

    /// Counts messages of a gate that are missing from this file.
    pub(crate) fn count_lost(&mut self, gate: usize, lost: u64) {
        if let Some((_, totals)) = self.gates.get_mut(&gate) {
            totals.lost += lost;
        }
    }

    /// Ends the open chunk and hands everything to the operating system, so that a crash of this process loses none of
    /// it.
    pub(crate) fn flush(&mut self) -> Result<(), WriteError> {
        if self.pending > 0 {
            self.index += INDEX_PER_CHUNK + INDEX_PER_CHUNK_AND_CHANNEL * self.channels.len() as u64;
            self.pending = 0;
        }
        self.writer.flush()?;
        self.flushed = self.written.load(Ordering::Relaxed);
        Ok(())
    }

    /// Checks that the path still leads to this file.
    ///
    /// # Errors
    /// The file was removed, renamed or replaced, so the recording would not be found.
    pub(crate) fn check_name(&self) -> Result<(), WriteError> {
        let own = self.file.metadata().map_err(McapError::from)?;
        let fault = match fs::metadata(&self.path) {
            Ok(named) if (named.dev(), named.ino()) == (own.dev(), own.ino()) => return Ok(()),
            Ok(_) => "the file was replaced by another one",
            Err(_) if own.nlink() == 0 => "the file was removed",
            Err(_) => "the file was renamed",
        };
        Err(WriteError::Moved(fault))
    }

    /// Waits until everything that was flushed is on the disk.
    pub(crate) fn sync(&self) -> io::Result<()> {
        self.file.sync_data()
    }

    /// Writes the totals and the index.
    pub(crate) fn finish(&mut self) -> Result<WrittenFile, WriteError> {
        let totals = self.totals();
        self.writer.write_metadata(&Metadata { name: Totals::NAME.to_owned(), metadata: totals.to_map() })?;
        self.writer.finish()?;
        let bytes = self.written.load(Ordering::Relaxed);
        // Release the space that was reserved beyond the end.
        self.file.set_len(bytes).map_err(McapError::from)?;
        Ok(WrittenFile { path: self.path.clone(), bytes, totals })
    }

    /// Ends the file at its last flush, without an index, after a failed write.
    pub(crate) fn abandon(self) -> WrittenFile {
        let totals = self.totals();
        let Self { path, file, writer, flushed, .. } = self;
        // Take the writer and its buffer apart: dropping them would write once more.
        let _unwritten = writer.into_inner().into_inner().into_parts();
        // Ignore errors: if the disk is gone, the file cannot be truncated.
        let _cut = file.set_len(flushed);
        WrittenFile { path, bytes: flushed, totals }
    }

    fn totals(&self) -> Totals {
        let mut gates = BTreeMap::<String, GateTotals>::new();
        for (name, counted) in self.gates.values() {
            let totals = gates.entry(name.clone()).or_default();
            totals.recorded += counted.recorded;
            totals.lost += counted.lost;
            totals.latched += counted.latched;
        }
        Totals { system: self.system.clone(), gates }
    }

    /// Makes sure that `more` bytes, the open chunk and the index fit on the disk.
    fn ensure_room(&mut self, more: u64) -> Result<(), WriteError> {
        let chunk = self.pending + more;
        // Incompressible data grows by less than this when LZ4 compresses it.
        let chunk = chunk + chunk / 128 + BUFFER as u64;
        let index = self.index + INDEX_PER_CHUNK + (INDEX_PER_CHUNK_AND_CHANNEL + 256) * self.channels.len() as u64;
        let size = self.written.load(Ordering::Relaxed) + chunk + index;
        self.room.ensure(&self.file, size).map_err(WriteError::Full)
    }
}

/// Size of the write buffer. Chunks are larger and are written directly; it collects the small records between them.
const BUFFER: usize = 64 << 10;

/// The options of every file that SCL writes.
pub(crate) fn options() -> WriteOptions {
    WriteOptions::new()
        .profile(PROFILE)
        .library(concat!("scl ", env!("CARGO_PKG_VERSION")))
        .compression(Some(Compression::Lz4))
        // A chunk is built in memory and written at once, so that a file that is cut off ends with a complete chunk.
        .disable_seeking(true)
        // Chunks are ended by `flush`, which keeps track of the space that they need.
        .chunk_size(None)
}

/// A file that counts what was written to it.
struct Counted {
    file: Arc<File>,
    written: Arc<AtomicU64>,
}

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let count = (&*self.file).write(bytes)?;
        self.written.fetch_add(count as u64, Ordering::Relaxed);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
