//! Folders of files that only their user can read, written all or none.

use std::fs::{self, DirBuilder, OpenOptions};
use std::io::{self, Write};
use std::os::unix::fs::{DirBuilderExt, OpenOptionsExt};
use std::path::Path;

/// Creates a folder with mode 0700, and those above it that are missing.
pub(super) fn create(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

/// Writes a folder of files with mode 0600, in place of one that is there.
///
/// It is written under another name and then renamed: a full disk leaves no half of a key, and what is to be replaced
/// stays until then.
pub(super) fn replace(folder: &Path, files: &[(&str, &str)]) -> io::Result<()> {
    // Removed at the end, with what was replaced.
    let beside = tempfile::Builder::new().prefix(".").tempdir_in(folder.parent().unwrap_or(folder))?;
    let (new, old) = (beside.path().join("new"), beside.path().join("old"));
    create(&new)?;
    for (name, text) in files {
        let mut file = OpenOptions::new().write(true).create_new(true).mode(0o600).open(new.join(name))?;
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
    }
    match fs::rename(folder, &old) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => fs::rename(&new, folder).inspect_err(|_| _ = fs::rename(&old, folder)),
    }
}
