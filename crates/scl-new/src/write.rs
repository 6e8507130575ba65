//! A folder of files, written all or none: beside its place first, then renamed.

use scl_terminal::Problem;
use std::io;
use std::path::{Path, PathBuf};

/// Refuses a name that something in `parent` has.
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
    let draft = Draft { folder: parent.join(format!(".{name}.{}", std::process::id())) };
    draft.fill(files).and_then(|()| std::fs::rename(&draft.folder, parent.join(name))).map_err(|error| {
        Problem::new(format!("cannot write the project `{name}`: {error}")).note("nothing was left behind")
    })
}

/// A folder that is removed unless it was renamed.
struct Draft {
    folder: PathBuf,
}

impl Draft {
    fn fill(&self, files: &[(String, String)]) -> io::Result<()> {
        std::fs::create_dir(&self.folder)?;
        for (path, text) in files {
            let path = self.folder.join(path);
            path.parent().map_or(Ok(()), std::fs::create_dir_all)?;
            std::fs::write(path, text)?;
        }
        Ok(())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // After the rename there is none.
        let _absent = std::fs::remove_dir_all(&self.folder);
    }
}
