//! Replaces a file as a whole, so that no reader ever sees a half-written one.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use tempfile::NamedTempFile;

/// Replaces a file that contains `old` by one that contains `new`, with the same permissions. If the path is a symbolic
/// link, its target is replaced and the link stays.
///
/// # Errors
///
/// The file no longer holds `old`, or the operating system refuses. The file is then as it was.
pub(super) fn replace_file(path: &Path, old: &str, new: &str) -> io::Result<()> {
    let path = fs::canonicalize(path)?;
    // In the same folder, because a rename is atomic only within one file system.
    let mut file = NamedTempFile::new_in(path.parent().unwrap_or(Path::new("/")))?;
    file.as_file().set_permissions(fs::metadata(&path)?.permissions())?;
    file.write_all(new.as_bytes())?;
    file.as_file().sync_all()?;
    // Check as late as possible: an editor may have saved the file in the meantime.
    if fs::read(&path)? != old.as_bytes() {
        return Err(io::Error::other("the file changed while it was being fixed"));
    }
    file.persist(path)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::replace_file;
    use std::fs;
    use std::os::unix::fs::{PermissionsExt, symlink};

    #[test]
    fn links_and_permissions_stay() {
        let folder = tempfile::tempdir().unwrap();
        let [file, link] = ["t.yaml", "link.yaml"].map(|name| folder.path().join(name));
        fs::write(&file, "old").unwrap();
        fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("t.yaml", &link).unwrap();
        replace_file(&link, "old", "new").unwrap();
        assert_eq!(fs::read_to_string(&file).unwrap(), "new");
        assert!(link.is_symlink());
        assert_eq!(fs::metadata(&file).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
    }

    #[test]
    fn a_file_that_changed_is_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("t.yaml");
        fs::write(&file, "edited").unwrap();
        assert!(replace_file(&file, "old", "new").is_err());
        assert_eq!(fs::read_to_string(&file).unwrap(), "edited");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
