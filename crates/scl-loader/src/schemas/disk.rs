//! The schema files on disk, as the schema compiler asks for them, with the limits of every file that SCL reads.

use super::limits;
use crate::read::{Unreadable, read_text};
use protox::Error;
use protox::file::{File, FileResolver, GoogleFileResolver};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// A schema file that was read.
#[derive(Debug, Clone)]
pub(super) struct SchemaFile {
    /// The name by which the compiler knows it.
    pub(super) name: String,
    /// Where it lies.
    pub(super) path: PathBuf,
    /// What is in it.
    pub(super) text: String,
}

/// Everything that was read so far, shared with the resolver that the compiler owns.
pub(super) type FilesRead = Arc<Mutex<Vec<SchemaFile>>>;

/// Finds schema files: beside the topology file, beside the schemas it names, and the well-known ones in the program.
pub(super) struct Disk {
    pub(super) folders: Vec<PathBuf>,
    pub(super) max_size: u64,
    pub(super) files: FilesRead,
}

impl FileResolver for Disk {
    fn resolve_path(&self, path: &Path) -> Option<String> {
        path.to_str().map(str::to_owned)
    }

    fn open_file(&self, name: &str) -> Result<File, Error> {
        for folder in &self.folders {
            let path = folder.join(name);
            match read_text(&path, self.max_size) {
                Err(Unreadable::Missing) => {}
                Err(cause) => return Err(Error::new(why(&path, cause))),
                Ok(text) => return self.open_text(name, path, text),
            }
        }
        GoogleFileResolver::new().open_file(name)
    }
}

impl Disk {
    fn open_text(&self, name: &str, path: PathBuf, text: String) -> Result<File, Error> {
        // The positions that the compiler reports count no byte order mark, as those of `Sources` do.
        let text = text.trim_start_matches('\u{feff}').to_owned();
        if let Some(why) = limits::exceeded(&text) {
            return Err(Error::new(why));
        }
        if let Some(other) = self.other_name(name, &path) {
            return Err(Error::new(format!(
                "`{name}` and `{other}` are the same file; use one of the two names everywhere"
            )));
        }
        let parsed = File::from_source(name, &text);
        let file = SchemaFile { name: name.to_owned(), path, text };
        // A panic elsewhere leaves the list whole, so a poisoned lock may be used.
        self.files.lock().unwrap_or_else(PoisonError::into_inner).push(file);
        parsed
    }
}

impl Disk {
    /// The other name under which the compiler already knows a file: its messages would be declared twice.
    fn other_name(&self, name: &str, path: &Path) -> Option<String> {
        let path = path.canonicalize().ok()?;
        let files = self.files.lock().unwrap_or_else(PoisonError::into_inner);
        let same = |file: &&SchemaFile| file.name != name && file.path.canonicalize().is_ok_and(|other| other == path);
        files.iter().find(same).map(|file| file.name.clone())
    }
}

/// Why a schema gives no text, in a few words.
pub(super) fn why(path: &Path, cause: Unreadable) -> String {
    let shown = path.display();
    match cause {
        Unreadable::Missing => format!("cannot find `{shown}`"),
        Unreadable::NotAFile(word) => format!("`{shown}` is {word}, not a file"),
        Unreadable::TooLarge(size) => format!("`{shown}` has {size} bytes, more than the limit"),
        Unreadable::NotUtf8(bad) => format!("`{shown}` is not valid UTF-8 (line {}, column {})", bad.line, bad.column),
        Unreadable::BrokenLink(error) | Unreadable::Refused(error) => format!("`{shown}` cannot be read: {error}"),
    }
}
