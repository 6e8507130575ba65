//! Generated files on disk: written only when they differ, and as a whole.

use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// A generated file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct File {
    /// Its name, without a folder.
    pub name: String,
    /// Its text.
    pub text: String,
}

/// What [`write()`] did.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Outcome {
    /// The file is new, or had another content.
    Written,
    /// The file had this content, and was not touched.
    Unchanged,
}

/// A generated file could not be written.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OutputError {
    /// The folder does not exist and cannot be made.
    #[error("cannot create the folder `{}`", .folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write `{}`", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// Writes a file into a folder, which is made if need be, unless it has this content already.
///
/// The file is replaced as a whole: a reader, and another program that writes it, never meets a part of it. Any number
/// of programs may write it at once. A symbolic link stays, and what it leads to is replaced.
///
/// # Errors
/// [`OutputError`]: the folder or the file cannot be written. The file is then as it was.
pub fn write(folder: &Path, file: &File) -> Result<Outcome, OutputError> {
    if is_current(folder, file) {
        return Ok(Outcome::Unchanged);
    }
    fs::create_dir_all(folder).map_err(|source| OutputError::Folder { folder: folder.to_owned(), source })?;
    let path = folder.join(&file.name);
    replace(&path, &file.text).map_err(|source| OutputError::File { path, source })?;
    Ok(Outcome::Written)
}

/// Returns true if the folder has the file with this content.
pub fn is_current(folder: &Path, file: &File) -> bool {
    let path = folder.join(&file.name);
    // A look at the length saves reading most files that differ, and keeps away from pipes and devices.
    let is_candidate = fs::metadata(&path).is_ok_and(|it| it.is_file() && it.len() == file.text.len() as u64);
    is_candidate && fs::read(&path).is_ok_and(|bytes| bytes == file.text.as_bytes())
}

/// More files than killed processes leave behind.
const ATTEMPTS: u32 = 1_000;

fn replace(path: &Path, text: &str) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let (temporary, mut file) = create_beside(&path)?;
    let done = file.write_all(text.as_bytes()).and_then(|()| fs::rename(&temporary, &path));
    if done.is_err() {
        // The first error is the one to report.
        let _ = fs::remove_file(&temporary);
    }
    done
}

/// A new file in the same folder, as only within one file system a rename is atomic. A file of that name may have been left
/// by a killed process with the same id: containers use few ids.
fn create_beside(path: &Path) -> io::Result<(PathBuf, fs::File)> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let mut attempt = 0;
    loop {
        let temporary = path.with_file_name(format!(".{name}.{}.{attempt}.tmp", std::process::id()));
        match OpenOptions::new().write(true).create_new(true).open(&temporary) {
            Ok(file) => return Ok((temporary, file)),
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists && attempt < ATTEMPTS => attempt += 1,
            Err(error) => return Err(error),
        }
    }
}
