//! Writes the stats file in place, and reads one that may be written at the same time.

use super::ComponentStats;
use super::layout::{BEGIN, BODY, COUNTER, decode, encode};
use crate::runtime_dir::SystemDir;
use crate::runtime_dir::error::RuntimeDirError;
use crate::runtime_dir::owned_path::OwnedPath;
use crate::runtime_dir::small_file::{open_file, write_temp};
use rustix::fs::OFlags;
use rustix::io::{pread, pwrite};
use std::fs::File;
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// Maximum size of a stats file that is read, in bytes: more than a component with ten thousand connections needs.
const LIMIT: usize = 16 << 20;

/// Maximum number of attempts to read a file that is written at the same time, which takes some microseconds of each
/// period.
const ATTEMPTS: usize = 100;

/// Time after which a reader gives up: between two attempts it yields the processor, which takes long on a busy
/// machine, and a file whose component was killed while it wrote will never be whole.
const PATIENCE: Duration = Duration::from_millis(100);

/// The stats file of a component of this process. Dropping it removes the file.
#[derive(Debug)]
pub(crate) struct StatsFile {
    placed: OwnedPath,
    /// What was written last.
    block: Vec<u8>,
    counter: u64,
    /// Whether the last write failed, so that it is logged once.
    failed: bool,
}

impl StatsFile {
    /// Creates the file, with mode 0600 and in one step.
    ///
    /// # Errors
    /// The file cannot be created or written.
    pub(crate) fn create(dir: &SystemDir, component: &str, stats: &ComponentStats) -> Result<Self, RuntimeDirError> {
        let mut block = Vec::new();
        encode(stats, 0, &mut block);
        let placed = place(dir, &dir.file_of(component, ".stats")?, &block)?;
        Ok(Self { placed, block, counter: 0, failed: false })
    }

    /// Creates the file again with what was written last, if it was removed.
    ///
    /// # Errors
    /// Those of [`create`](Self::create).
    pub(crate) fn restore(&mut self, dir: &SystemDir) -> Result<(), RuntimeDirError> {
        if !self.is_in_place() {
            let path = self.placed.path().to_owned();
            self.placed = place(dir, &path, &self.block)?;
        }
        Ok(())
    }

    pub(crate) fn is_in_place(&self) -> bool {
        self.placed.is_ours()
    }

    /// Replaces the figures, which must be of the same gates and connections. Allocates nothing. A file that cannot be
    /// written, or was removed, does no harm.
    pub(crate) fn write(&mut self, stats: &ComponentStats) {
        self.counter += 1;
        encode(stats, self.counter, &mut self.block);
        let file = self.placed.file();
        let written = write_block(&self.block, |bytes, at| Ok(pwrite(file, bytes, at)?));
        if let Err(error) = &written
            && !self.failed
        {
            tracing::debug!(path = %self.placed.path().display(), %error, "cannot write the stats of the component");
        }
        self.failed = written.is_err();
    }
}

fn place(dir: &SystemDir, path: &Path, block: &[u8]) -> Result<OwnedPath, RuntimeDirError> {
    write_temp(dir.folder(), path, block)?.rename(path, OFlags::WRONLY)
}

/// Writes a block in three steps, so that no reordering within a write makes a half-written block look whole.
fn write_block(block: &[u8], mut write: impl FnMut(&[u8], u64) -> io::Result<usize>) -> io::Result<()> {
    let end = block.len() - COUNTER;
    for (from, to) in [(BEGIN, BODY), (BODY, end), (end, block.len())] {
        if write(&block[from..to], from as u64)? != to - from {
            return Err(io::ErrorKind::WriteZero.into());
        }
    }
    Ok(())
}

/// Reads a stats file. Returns `None` if the file does not exist, is not whole, or cannot be understood.
pub(super) fn read(path: &Path) -> Option<ComponentStats> {
    let file = open_file(path).ok()?;
    let (mut block, start) = (Vec::new(), Instant::now());
    for _ in 0..ATTEMPTS {
        if read_whole(&file, &mut block).ok()? {
            return decode(&block);
        }
        if start.elapsed() >= PATIENCE {
            break;
        }
        std::thread::yield_now();
    }
    None
}

/// Reads the file once. Returns true if it was not written at the same time.
fn read_whole(file: &File, block: &mut Vec<u8>) -> io::Result<bool> {
    let found = file.metadata()?;
    let length = usize::try_from(found.len()).unwrap_or(usize::MAX);
    if !found.is_file() || !(BODY + COUNTER..=LIMIT).contains(&length) {
        return Err(io::ErrorKind::InvalidData.into());
    }
    let (mut begin, mut end) = ([0; COUNTER], [0; COUNTER]);
    read_at(file, &mut end, length - COUNTER)?;
    block.resize(length, 0);
    read_at(file, block, 0)?;
    read_at(file, &mut begin, BEGIN)?;
    Ok(begin == end)
}

fn read_at(file: &File, mut into: &mut [u8], mut at: usize) -> io::Result<()> {
    while !into.is_empty() {
        let read = pread(file, &mut *into, at as u64)?;
        if read == 0 {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        into = &mut into[read..];
        at += read;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_written_in_the_order_that_readers_rely_on() {
        let block: Vec<u8> = (0..200).collect();
        let mut written = Vec::new();
        write_block(&block, |bytes, at| {
            written.push((at, bytes.to_vec()));
            Ok(bytes.len())
        })
        .unwrap();
        let expected = [16..24, 24..192, 192..200].map(|part| (part.start as u64, block[part].to_vec()));
        assert_eq!(written, expected);
    }
}
