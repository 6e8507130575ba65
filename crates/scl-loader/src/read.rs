//! Reads the file at a path as text, or says why that is not possible.

use std::fs::{self, File, FileType};
use std::io::{self, Read};
use std::path::Path;

/// Why a file could not be read as text.
#[derive(Debug)]
pub(crate) enum Unreadable {
    /// The file does not exist.
    Missing,
    /// A symbolic link that leads nowhere or in a circle.
    BrokenLink(io::Error),
    /// Something other than a regular file, as messages call it: `a directory`.
    NotAFile(&'static str),
    /// The operating system refused.
    Refused(io::Error),
    /// More bytes than allowed: the size that the file reports, or else the number of bytes that were read.
    TooLarge(u64),
    /// Not UTF-8.
    NotUtf8(BadByte),
}

/// The first byte that is not UTF-8.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct BadByte {
    /// The whole text, with U+FFFD in place of what is not UTF-8.
    pub(crate) text: String,
    /// Its value.
    pub(crate) value: u8,
    /// The byte after it.
    pub(crate) next: Option<u8>,
    /// Its position, from 0.
    pub(crate) offset: usize,
    /// Its line, from 1.
    pub(crate) line: usize,
    /// Its column, from 1, in characters.
    pub(crate) column: usize,
}

/// Reads a regular file of at most `max_size` bytes.
///
/// The file type is checked before the file is opened, because opening a pipe blocks until its other end is opened.
pub(crate) fn read_text(path: &Path, max_size: u64) -> Result<String, Unreadable> {
    let about = fs::metadata(path).map_err(|error| classify(path, error))?;
    let kind = about.file_type();
    if !kind.is_file() {
        return Err(Unreadable::NotAFile(word(kind)));
    }
    if about.len() > max_size {
        return Err(Unreadable::TooLarge(about.len()));
    }
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(Unreadable::Refused)?;
    // Read one byte more than allowed: the file may have grown, or may not report its length.
    file.take(max_size.saturating_add(1)).read_to_end(&mut bytes).map_err(Unreadable::Refused)?;
    decode(bytes, max_size)
}

/// Decodes bytes as UTF-8, if there are at most `max_size`.
pub(crate) fn decode(bytes: Vec<u8>, max_size: u64) -> Result<String, Unreadable> {
    if bytes.len() as u64 > max_size {
        return Err(Unreadable::TooLarge(bytes.len() as u64));
    }
    String::from_utf8(bytes).map_err(|error| Unreadable::NotUtf8(first_bad_byte(error.as_bytes(), error.utf8_error())))
}

fn classify(path: &Path, error: io::Error) -> Unreadable {
    let is_link = fs::symlink_metadata(path).is_ok_and(|about| about.is_symlink());
    match error.kind() {
        _ if is_link => Unreadable::BrokenLink(error),
        io::ErrorKind::NotFound => Unreadable::Missing,
        _ => Unreadable::Refused(error),
    }
}

#[cfg(unix)]
fn word(kind: FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match kind {
        _ if kind.is_dir() => "a directory",
        _ if kind.is_fifo() => "a named pipe",
        _ if kind.is_socket() => "a socket",
        _ if kind.is_char_device() || kind.is_block_device() => "a device",
        _ => "something else",
    }
}

#[cfg(not(unix))]
fn word(kind: FileType) -> &'static str {
    if kind.is_dir() { "a directory" } else { "something else" }
}

fn first_bad_byte(bytes: &[u8], error: std::str::Utf8Error) -> BadByte {
    let offset = error.valid_up_to();
    let valid = String::from_utf8_lossy(&bytes[..offset]);
    let line = valid.matches('\n').count() + 1;
    let column = valid.rsplit('\n').next().unwrap_or("").chars().count() + 1;
    let value = bytes.get(offset).copied().unwrap_or_default();
    BadByte {
        text: String::from_utf8_lossy(bytes).into_owned(),
        value,
        next: bytes.get(offset + 1).copied(),
        offset,
        line,
        column,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_bad_byte_is_counted_in_lines_and_characters() {
        let text = [b"a\n".as_slice(), "äb".as_bytes(), &[0xff, 0xfe]].concat();
        let error = std::str::from_utf8(&text).unwrap_err();
        let shown = "a\näb\u{fffd}\u{fffd}".to_owned();
        let expected = BadByte { text: shown, value: 0xff, next: Some(0xfe), offset: 5, line: 2, column: 3 };
        assert_eq!(first_bad_byte(&text, error), expected);
    }
}
