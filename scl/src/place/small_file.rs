use std::{
    fs,
    io::{self, Read, Write},
    os::unix::fs::OpenOptionsExt,
    path::Path,
};

use rustix::fs::OFlags;

use super::{claim::Claim, draft::Draft, error::PlaceError};

/// The most that is read of a file: far more than any of ours holds, and no burden for memory.
const LIMIT: u64 = 1 << 20;

/// Writes a file of mode 0600 in one step: whoever reads it sees all of it or what was there before.
pub(super) fn write_file(folder: &Path, path: &Path, text: &str) -> Result<Claim, PlaceError> {
    let create = |draft: &Path| fs::OpenOptions::new().write(true).create_new(true).mode(0o600).open(draft);
    let (draft, mut file) =
        Draft::create(folder, create).map_err(|error| PlaceError::io("make the file", path, error))?;
    file.write_all(text.as_bytes()).map_err(|error| PlaceError::io("write the file", path, error))?;
    draft.place(path)
}

/// Reads a file, 1 MiB of it at most. A link is an error, and a pipe does not make this wait.
pub(super) fn read_file(path: &Path) -> io::Result<String> {
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed();
    let file = fs::OpenOptions::new().read(true).custom_flags(flags).open(path)?;
    let mut text = String::new();
    file.take(LIMIT).read_to_string(&mut text)?;
    Ok(text)
}
