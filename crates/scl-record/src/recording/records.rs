//! The records of an MCAP file: an opcode, a length and that many bytes, one after the other.

use mcap::MAGIC;
use scl_terminal::Problem;
use std::fs::File;
use std::io::{self, BufReader, ErrorKind, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Opcode and length.
const HEADER: u64 = 1 + 8;
/// Shorter distances are skipped within the buffer, which most likely contains the bytes.
const NEAR: u64 = 64 << 10;

/// Walks over the records of a file without interpreting them.
#[derive(Debug)]
pub(crate) struct Records {
    path: PathBuf,
    file: BufReader<File>,
    /// Where the next record begins.
    offset: u64,
    /// Bytes of the current record that were not read yet.
    unread: u64,
    size: u64,
}

/// The beginning of a record.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct RecordHeader {
    pub(crate) opcode: u8,
    /// Where the record begins in the file.
    pub(crate) offset: u64,
    /// Length of its content according to the header, even if the file ends before.
    pub(crate) length: u64,
    /// Whether the file ends before the record does.
    pub(crate) is_cut: bool,
}

impl Records {
    /// Opens a file and reads its first bytes.
    ///
    /// # Errors
    /// It cannot be read, is empty, or is not an MCAP file.
    pub(super) fn open(path: &Path) -> Result<Self, Problem> {
        let unreadable = |error| unreadable(path, &error);
        let mut file = File::open(path).map_err(unreadable)?;
        let metadata = file.metadata().map_err(unreadable)?;
        let place = path.display().to_string();
        if !metadata.is_file() {
            return Err(Problem::new(format!("`{place}` is not a file")).help("name a file written by `scl record`"));
        }
        if metadata.len() == 0 {
            let help = "the recorder was stopped before it wrote anything, or the disk was full";
            return Err(Problem::new(format!("the recording `{place}` is empty")).help(help));
        }
        let mut magic = Vec::new();
        file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut magic).map_err(unreadable)?;
        if !MAGIC.starts_with(&magic) {
            let help = "recordings are MCAP files, written by `scl record`";
            return Err(Problem::new(format!("`{place}` is not a recording")).help(help));
        }
        Ok(Self::new(path, file, magic.len() as u64, metadata.len()))
    }

    /// Goes on with the record that begins at this byte.
    pub(super) fn go_to(&mut self, offset: u64) -> Result<(), Problem> {
        self.file.seek(SeekFrom::Start(offset)).map_err(|error| unreadable(&self.path, &error))?;
        (self.offset, self.unread) = (offset, 0);
        Ok(())
    }

    /// The records of a file of this size, whose first `offset` bytes were read already.
    pub(crate) fn new(path: &Path, file: File, offset: u64, size: u64) -> Self {
        Self { path: path.to_owned(), file: BufReader::new(file), offset, unread: 0, size }
    }

    /// The next record; `None` at the end of the file.
    pub(crate) fn next(&mut self) -> Result<Option<RecordHeader>, Problem> {
        self.skip()?;
        let left = self.size.saturating_sub(self.offset);
        let mut header = [0; HEADER as usize];
        if left < HEADER || self.read_exact(&mut header)?.is_none() {
            let cut = (left > 0).then_some(RecordHeader { opcode: 0, offset: self.offset, length: 0, is_cut: true });
            self.offset = self.size;
            return Ok(cut);
        }
        let [opcode, length @ ..] = header;
        let (length, available) = (u64::from_le_bytes(length), left - HEADER);
        let record = RecordHeader { opcode, offset: self.offset, length, is_cut: length > available };
        self.unread = length.min(available);
        self.offset += HEADER + self.unread;
        Ok(Some(record))
    }

    /// Reads the content of the current record, or its first `limit` bytes.
    pub(crate) fn content(&mut self, limit: u64) -> Result<Vec<u8>, Problem> {
        let mut content = Vec::new();
        let read = self.file.by_ref().take(self.unread.min(limit)).read_to_end(&mut content);
        self.unread -= read.map_err(|error| unreadable(&self.path, &error))? as u64;
        Ok(content)
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Where the next record begins.
    pub(crate) fn position(&self) -> u64 {
        self.offset
    }

    /// A problem in this file at this byte.
    pub(super) fn problem(&self, offset: u64, message: impl Into<String>) -> Problem {
        Problem::new(message).at(format!("{}, byte {offset}", self.path.display()))
    }

    fn skip(&mut self) -> Result<(), Problem> {
        let unread = std::mem::take(&mut self.unread);
        let distance = i64::try_from(unread).unwrap_or(i64::MAX);
        let skipped = match unread {
            0 => Ok(()),
            1..NEAR => self.file.seek_relative(distance),
            _ => self.file.seek(SeekFrom::Current(distance)).map(drop),
        };
        skipped.map_err(|error| unreadable(&self.path, &error))
    }

    /// Fills the buffer; `None` if the file has become shorter.
    fn read_exact(&mut self, buffer: &mut [u8]) -> Result<Option<()>, Problem> {
        match self.file.read_exact(buffer) {
            Ok(()) => Ok(Some(())),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => Ok(None),
            Err(error) => Err(unreadable(&self.path, &error)),
        }
    }
}

fn unreadable(path: &Path, error: &io::Error) -> Problem {
    let problem = Problem::new(format!("cannot read `{}`: {error}", path.display()));
    match error.kind() {
        ErrorKind::NotFound => problem.help("name a file written by `scl record`"),
        _ => problem,
    }
}
