//! Reserving memory before it is written.
//!
//! The engine's segments are files with holes. Writing into a hole when no memory is left ends the program with SIGBUS,
//! so each sample's memory is reserved with `fallocate` before its first use, which reports that as an error.

use crate::limits::{HEADERS, TooLittle, available};
use rustix::fs::{FallocateFlags, fallocate};
use rustix::io::Errno;
use std::collections::HashMap;
use std::fs::{self, File};
use std::os::unix::fs::MetadataExt;

const PAGE: usize = 4096;

/// The memory that is reserved in the segment from which samples are currently lent.
#[derive(Debug, Default)]
pub(crate) struct Committed {
    segment: Option<Segment>,
    /// Address of each sample, and the length that is reserved for it.
    samples: HashMap<usize, usize>,
}

/// A mapped file.
#[derive(Debug)]
struct Segment {
    file: File,
    start: usize,
    end: usize,
    inode: u64,
}

impl Committed {
    /// Makes the next sample look the segment up again, because there may be a new one.
    pub(crate) fn grown(&mut self) {
        self.segment = None;
    }

    /// Reserves the memory of a sample whose payload is at `address`.
    pub(crate) fn reserve(&mut self, address: usize, length: usize) -> Result<(), TooLittle> {
        let is_inside = |segment: &Segment| (segment.start..segment.end).contains(&address);
        if !self.segment.as_ref().is_some_and(is_inside) {
            // Samples of a new segment may have the addresses of samples of an older one.
            self.samples.clear();
            self.segment = Segment::find(address);
        }
        if self.samples.get(&address).is_some_and(|&reserved| reserved >= length) {
            return Ok(());
        }
        if let Some(segment) = &self.segment {
            segment.reserve(address, length)?;
            self.samples.insert(address, length);
        }
        Ok(())
    }
}

impl Segment {
    /// The file that is mapped at an address.
    fn find(address: usize) -> Option<Self> {
        let maps = fs::read_to_string("/proc/self/maps").ok()?;
        maps.lines().find_map(|line| Self::parse(line, address))
    }

    /// Reads a line of `/proc/self/maps`, `start-end rw-s offset device inode path`. Returns `None` if it does not map
    /// `address`, or if the file cannot be used.
    fn parse(line: &str, address: usize) -> Option<Self> {
        let mut words = line.split_ascii_whitespace();
        let (start, end) = words.next()?.split_once('-')?;
        let hexadecimal = |text| usize::from_str_radix(text, 16).ok();
        let (start, end) = (hexadecimal(start)?, hexadecimal(end)?);
        if !(start..end).contains(&address) {
            return None;
        }
        let (offset, inode, path) = (words.nth(1)?, words.nth(1)?, words.next()?);
        let file = File::options().write(true).open(path).ok()?;
        let inode = inode.parse().ok()?;
        let is_same = offset.bytes().all(|digit| digit == b'0') && file.metadata().ok()?.ino() == inode;
        is_same.then_some(Self { file, start, end, inode })
    }

    fn reserve(&self, address: usize, length: usize) -> Result<(), TooLittle> {
        let first = (address - self.start).saturating_sub(HEADERS) / PAGE * PAGE;
        let last = (address - self.start + length).min(self.end - self.start);
        let needed = (last - first) as u64;
        loop {
            return match fallocate(&self.file, FallocateFlags::KEEP_SIZE, first as u64, needed) {
                Err(Errno::INTR) => continue,
                Err(Errno::NOSPC | Errno::NOMEM | Errno::DQUOT) => Err(TooLittle { needed, available: available() }),
                // Some kernels cannot reserve shared memory. Then the caller's check must suffice.
                Err(error) => {
                    tracing::debug!(%error, inode = self.inode, "shared memory cannot be reserved");
                    Ok(())
                }
                Ok(()) => Ok(()),
            };
        }
    }
}
