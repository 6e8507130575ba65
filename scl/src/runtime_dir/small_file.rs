//! Reading and writing the small files in a system's folder.

use super::error::RuntimeDirError;
use super::temp_entry::TempEntry;
use rustix::fs::OFlags;
use std::fs::{File, OpenOptions};
use std::io::{self, Read, Write};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;

/// Writes a file of mode 0600 under a temporary name.
pub(super) fn write_temp(folder: &Path, path: &Path, content: &[u8]) -> Result<TempEntry, RuntimeDirError> {
    let create = |path: &Path| OpenOptions::new().write(true).create_new(true).mode(0o600).open(path);
    let (entry, mut file) =
        TempEntry::create(folder, create).map_err(|error| RuntimeDirError::io("create the file", path, error))?;
    file.write_all(content).map_err(|error| RuntimeDirError::io("write the file", path, error))?;
    Ok(entry)
}

/// Opens a file for reading. Does not follow links, and does not wait at pipes.
pub(super) fn open_file(path: &Path) -> io::Result<File> {
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed();
    OpenOptions::new().read(true).custom_flags(flags).open(path)
}

/// Reads a file of at most `limit` bytes. Does not follow links, and does not wait at pipes.
pub(super) fn read_file(path: &Path, limit: u64) -> io::Result<Vec<u8>> {
    let file = open_file(path)?;
    let mut content = Vec::new();
    file.take(limit.saturating_add(1)).read_to_end(&mut content)?;
    if content.len() as u64 > limit {
        return Err(io::ErrorKind::FileTooLarge.into());
    }
    Ok(content)
}
