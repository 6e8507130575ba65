//! The records of a recording that may end anywhere.

use crate::parse::{CHUNK_HEAD, LONGEST, chunk_options};
use mcap::records::op;
use mcap::sans_io::{LinearReadEvent, LinearReader};
use mcap::{MAGIC, McapError};
use std::io::{self, Read};

/// Opcode and length.
const PREFIX: usize = 9;

/// The records of the data section, one after the other, up to its end or to where the file is cut off.
pub(super) struct FileRecords<R> {
    input: R,
    size: u64,
    /// End of the last record that was read.
    position: u64,
    ended: bool,
    is_complete: bool,
}

/// One record of a file.
pub(super) enum FileRecord<'a, R> {
    Record(u8, Vec<u8>),
    Chunk(Chunk<'a, R>),
}

/// The records inside a chunk.
pub(super) struct Chunk<'a, R> {
    file: &'a mut FileRecords<R>,
    reader: Box<LinearReader>,
    /// Bytes of the chunk's record in the file, and whether that is all of it.
    size: u64,
    is_whole: bool,
    /// Bytes of it that were not read yet.
    unread: u64,
}

/// What became of a chunk.
pub(super) enum ChunkEnd {
    Sound,
    /// Number of bytes in the file that are not a complete and undamaged chunk.
    Damaged(u64),
    /// As many bytes, compressed with a method of this name.
    Unsupported(u64, String),
}

impl<R: Read> FileRecords<R> {
    /// Reads the beginning of a file of this size.
    ///
    /// # Errors
    /// It is not the beginning of an MCAP file.
    pub(super) fn open(mut input: R, size: u64) -> io::Result<Self> {
        let mut magic = [0; MAGIC.len()];
        input.read_exact(&mut magic).map_err(|_| io::Error::other("it is too short"))?;
        if magic != MAGIC {
            return Err(io::Error::other("it does not begin with MCAP's magic bytes"));
        }
        Ok(Self { input, size, position: MAGIC.len() as u64, ended: false, is_complete: false })
    }

    /// How far the file has been read.
    pub(super) fn position(&self) -> u64 {
        self.position
    }

    /// Bytes at the end of the file that could not be read.
    pub(super) fn rest(&self) -> u64 {
        if self.is_complete { 0 } else { self.size - self.position }
    }

    /// Whether the file has the end of a complete one.
    pub(super) fn is_complete(&self) -> bool {
        self.is_complete
    }

    /// The next record; `None` at the end of the data section or where the file is cut off.
    pub(super) fn next(&mut self) -> io::Result<Option<FileRecord<'_, R>>> {
        if self.ended || self.size - self.position < PREFIX as u64 {
            self.ended = true;
            return Ok(None);
        }
        let mut prefix = [0; PREFIX];
        self.input.read_exact(&mut prefix)?;
        let (opcode, length) = (prefix[0], length_of(&prefix));
        let available = self.size - self.position - PREFIX as u64;
        if opcode == op::CHUNK {
            return Ok(Some(FileRecord::Chunk(self.chunk(&prefix, length, available)?)));
        }
        if opcode == 0 || length > available.min(LONGEST as u64) {
            self.ended = true;
            return Ok(None);
        }
        let mut body = vec![0; usize::try_from(length).map_err(io::Error::other)?];
        self.input.read_exact(&mut body)?;
        self.position += PREFIX as u64 + length;
        if opcode == op::DATA_END {
            self.ended = true;
            self.is_complete = self.ends_well()?;
            return Ok(None);
        }
        Ok(Some(FileRecord::Record(opcode, body)))
    }

    fn chunk(&mut self, prefix: &[u8; PREFIX], length: u64, available: u64) -> io::Result<Chunk<'_, R>> {
        let (size, is_whole) = (length.min(available), length <= available);
        let mut head = Vec::with_capacity(CHUNK_HEAD);
        (&mut self.input).take(size.min(CHUNK_HEAD as u64)).read_to_end(&mut head)?;
        // Of a whole chunk, nothing is used if its checksum is wrong; what is left of another one cannot be checked.
        let mut reader = LinearReader::new_with_options(
            chunk_options(&head, usize::try_from(size).unwrap_or(usize::MAX))
                .with_validate_chunk_crcs(is_whole)
                .with_prevalidate_chunk_crcs(is_whole),
        );
        let begin = [&prefix[..], &head].concat();
        reader.insert(begin.len()).copy_from_slice(&begin);
        reader.notify_read(begin.len());
        let unread = size - head.len() as u64;
        Ok(Chunk { file: self, reader: Box::new(reader), size, is_whole, unread })
    }

    /// Whether summary, footer and magic follow, and nothing else.
    fn ends_well(&mut self) -> io::Result<bool> {
        let mut position = self.position;
        let mut last = 0;
        while self.size - position >= (PREFIX + MAGIC.len()) as u64 {
            let mut prefix = [0; PREFIX];
            self.input.read_exact(&mut prefix)?;
            let length = length_of(&prefix);
            let available = self.size - position - PREFIX as u64;
            if length > available || io::copy(&mut (&mut self.input).take(length), &mut io::sink())? < length {
                return Ok(false);
            }
            position += PREFIX as u64 + length;
            last = prefix[0];
        }
        let mut end = Vec::new();
        self.input.read_to_end(&mut end)?;
        Ok(last == op::FOOTER && end == MAGIC)
    }
}

impl<R: Read> Chunk<'_, R> {
    /// Gives `take` each record up to the end of the chunk, to where it is cut off, or to where it is damaged.
    pub(super) fn read<E: From<io::Error>>(
        mut self,
        mut take: impl FnMut(u8, &[u8]) -> Result<(), E>,
    ) -> Result<ChunkEnd, E> {
        let mut unread = self.unread;
        let size = PREFIX as u64 + self.size;
        let end = loop {
            match self.reader.next_event() {
                Some(Ok(LinearReadEvent::ReadRequest(wanted))) => {
                    let wanted = wanted.min(usize::try_from(unread).unwrap_or(usize::MAX)).min(READ);
                    let read = self.file.input.read(self.reader.insert(wanted))?;
                    self.reader.notify_read(read);
                    unread -= read as u64;
                    if read == 0 {
                        break if self.is_whole && unread == 0 { ChunkEnd::Sound } else { ChunkEnd::Damaged(size) };
                    }
                }
                Some(Ok(LinearReadEvent::Record { opcode, data })) => take(opcode, data)?,
                Some(Err(McapError::UnsupportedCompression(name))) => break ChunkEnd::Unsupported(size, name),
                Some(Err(_)) | None => break ChunkEnd::Damaged(size),
            }
        };
        io::copy(&mut (&mut self.file.input).take(unread), &mut io::sink())?;
        self.file.position += size;
        self.file.ended |= !self.is_whole;
        Ok(end)
    }
}

/// Bytes read at once: a reader of a damaged chunk may ask for any amount.
const READ: usize = 1 << 20;

fn length_of(prefix: &[u8; PREFIX]) -> u64 {
    let mut length = [0; 8];
    length.copy_from_slice(&prefix[1..]);
    u64::from_le_bytes(length)
}
