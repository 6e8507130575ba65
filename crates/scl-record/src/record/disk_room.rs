//! Room on the disk: reserved ahead, so that a recording can always be completed with its index.
//!
//! A write that fails in the middle of a chunk would leave a file without an index. So the blocks of the next messages
//! and of the index are allocated before the messages are accepted; if that fails, the file is completed instead.

use rustix::fs::{FallocateFlags, fallocate, fstatvfs};
use rustix::io::Errno;
use rustix::process::{Resource, getrlimit};
use std::fs::File;
use std::io;

/// Bytes reserved at once, so that most messages need no system call.
const STEP: u64 = 4 << 20;

/// The disk space reserved for one file that is appended to.
#[derive(Debug, Default)]
pub(crate) struct DiskRoom {
    /// Size to which the file can grow.
    reserved: u64,
}

impl DiskRoom {
    /// Makes sure that the file can grow to `size` bytes.
    ///
    /// # Errors
    /// The disk is full, the quota is used up, or the process may not write larger files.
    pub(crate) fn ensure(&mut self, file: &File, size: u64) -> io::Result<()> {
        if size <= self.reserved {
            return Ok(());
        }
        let limit = getrlimit(Resource::Fsize).current.unwrap_or(u64::MAX);
        if size > limit {
            return Err(Errno::FBIG.into());
        }
        let generous = size.saturating_add(STEP).min(limit);
        let reserved = reserve(file, self.reserved, generous).map(|()| generous);
        self.reserved = reserved.or_else(|_| reserve(file, self.reserved, size).map(|()| size))?;
        Ok(())
    }
}

fn reserve(file: &File, from: u64, to: u64) -> io::Result<()> {
    match fallocate(file, FallocateFlags::KEEP_SIZE, from, to - from) {
        Ok(()) => Ok(()),
        Err(error @ (Errno::NOSPC | Errno::DQUOT | Errno::FBIG)) => Err(error.into()),
        // Some file systems cannot reserve space. Check the free blocks instead, although other programs may take them.
        Err(_) => {
            let free = fstatvfs(file).map_or(u64::MAX, |disk| disk.f_bavail.saturating_mul(disk.f_frsize));
            if free < to - from { Err(Errno::NOSPC.into()) } else { Ok(()) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_is_reserved_without_changing_the_size() {
        let file = tempfile::tempfile().unwrap();
        let mut room = DiskRoom::default();
        room.ensure(&file, 1000).unwrap();
        assert!(room.reserved >= 1000);
        assert_eq!(file.metadata().unwrap().len(), 0);
    }

    #[test]
    fn more_than_the_disk_has_is_refused() {
        let file = tempfile::tempfile().unwrap();
        let mut room = DiskRoom::default();
        assert!(room.ensure(&file, 1 << 60).is_err());
        room.ensure(&file, 1000).unwrap();
    }
}
