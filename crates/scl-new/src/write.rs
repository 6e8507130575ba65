//! Writes a folder of files, all of them or none: into a temporary folder beside it first, which is then renamed.

use scl_terminal::Problem;
use std::fs::Permissions;
use std::io;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use tempfile::{Builder, TempDir};

/// Rejects a name that a file or folder in `parent` already has.
pub(crate) fn check_absent(parent: &Path, name: &str) -> Result<(), Problem> {
    let existing = match std::fs::symlink_metadata(parent.join(name)) {
        Ok(existing) => existing,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(error) => return Err(Problem::new(format!("cannot look for `{name}`: {error}"))),
    };
    let kind = if existing.is_dir() { "folder" } else { "file" };
    Err(Problem::new(format!("a {kind} called `{name}` exists already"))
        .help("choose another name, or remove it first")
        .note("`scl new` writes into new folders only"))
}

/// Writes the files into the new folder `name` of `parent`.
pub(crate) fn write_all(parent: &Path, name: &str, files: &[(String, String)]) -> Result<(), Problem> {
    write_draft(parent, files).and_then(|draft| std::fs::rename(draft.path(), parent.join(name))).map_err(|error| {
        Problem::new(format!("cannot write the project `{name}`: {error}")).note("nothing was left behind")
    })
}

/// Writes the files into a temporary folder in `parent`, which is removed unless it is renamed.
fn write_draft(parent: &Path, files: &[(String, String)]) -> io::Result<TempDir> {
    // The umask decides who may read the project; temporary folders are private by default.
    let draft = Builder::new().permissions(Permissions::from_mode(0o777)).tempdir_in(parent)?;
    for (path, text) in files {
        let path = draft.path().join(path);
        path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
        std::fs::write(path, text)?;
    }
    Ok(draft)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_new_folder_has_the_usual_permissions_and_nothing_is_left_beside_it() {
        let parent = tempfile::tempdir().unwrap();
        write_all(parent.path(), "rover", &[("src/main.rs".to_owned(), "text".to_owned())]).unwrap();
        fs::create_dir(parent.path().join("usual")).unwrap();
        let mode = |name| fs::metadata(parent.path().join(name)).unwrap().permissions().mode();
        assert_eq!(mode("rover"), mode("usual"));
        assert_eq!(fs::read_to_string(parent.path().join("rover/src/main.rs")).unwrap(), "text");
        // It cannot be replaced by a rename.
        assert!(write_all(parent.path(), "rover", &[]).is_err());
        assert_eq!(fs::read_dir(parent.path()).unwrap().count(), 2);
    }
}
