//! Generated files on disk: written only when they differ, and as a whole.

use std::fs::{self, Permissions};
use std::io::{self, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use tempfile::Builder;
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
    /// The file did not exist, or had different content.
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
        /// The cause.
        source: io::Error,
    },
    /// The file cannot be written.
    #[error("cannot write `{}`", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// The cause.
        source: io::Error,
    },
}

/// Writes a file into a folder, unless the file has this content already. Creates the folder if needed.
///
/// The file is replaced as a whole: neither a reader nor another writer ever sees a partial file. Any number of
/// programs may write it at once. A symbolic link stays, and its target is replaced.
///
/// # Errors
/// [`OutputError`]: the folder or the file cannot be written. The file is then unchanged.
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
    // Checking the file type and length first avoids reading pipes, devices and most changed files.
    let is_candidate = fs::metadata(&path).is_ok_and(|it| it.is_file() && it.len() == file.text.len() as u64);
    is_candidate && fs::read(&path).is_ok_and(|bytes| bytes == file.text.as_bytes())
}

fn replace(path: &Path, text: &str) -> io::Result<()> {
    let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // In the same folder, because a rename is atomic only within one file system. The umask decides who may read it.
    let mut file = Builder::new().permissions(Permissions::from_mode(0o666)).tempfile_in(folder)?;
    file.write_all(text.as_bytes())?;
    file.persist(path)?;
    Ok(())
}
