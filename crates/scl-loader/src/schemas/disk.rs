//! Reads schema files from disk for the schema compiler, with the limits that apply to every file that SCL reads.

use super::edition;
use super::folders::Folders;
use super::imports::{Imported, is_built_in, look_up};
use super::limits;
use super::mistake::Mistake;
use crate::read::{Unreadable, read_text};
use crate::unreadable::why;
use protox::Error;
use protox::file::{File, FileResolver, GoogleFileResolver};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A schema file that was read.
#[derive(Debug, Clone)]
pub(super) struct SchemaFile {
    /// The name by which the compiler knows it.
    pub(super) name: String,
    /// Its path on disk.
    pub(super) path: PathBuf,
    /// Its content, without a byte order mark.
    pub(super) text: String,
}

/// The files that were read so far and the mistakes in them, shared with the resolver that the compiler owns.
#[derive(Debug, Default)]
pub(super) struct Seen {
    pub(super) files: Vec<SchemaFile>,
    /// The files that imports can mean.
    pub(super) imported: Vec<PathBuf>,
    /// The mistakes since they were last taken.
    pub(super) mistakes: Vec<Mistake>,
}

impl Seen {
    /// All files on which the result depends.
    pub(super) fn into_paths(self) -> Vec<PathBuf> {
        let mut known = HashSet::new();
        let read = self.files.into_iter().map(|file| file.path);
        read.chain(self.imported).filter(|path| known.insert(path.clone())).collect()
    }
}

/// A cell for [`Seen`]. Poisoning of the lock is ignored, because a panic leaves the value consistent.
#[derive(Debug, Clone, Default)]
pub(super) struct SharedSeen(Arc<Mutex<Seen>>);

impl SharedSeen {
    pub(super) fn get(&self) -> MutexGuard<'_, Seen> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Finds schema files in their folders, and the well-known ones in the program.
pub(super) struct Disk {
    pub(super) folders: Folders,
    pub(super) max_size: u64,
    pub(super) seen: SharedSeen,
}

impl FileResolver for Disk {
    fn resolve_path(&self, path: &Path) -> Option<String> {
        path.to_str().map(str::to_owned)
    }

    fn open_file(&self, name: &str) -> Result<File, Error> {
        // Ignore a copy on disk: it could differ from the file that is built into each language.
        if is_built_in(name) {
            return GoogleFileResolver::new().open_file(name);
        }
        for path in self.folders.paths(name) {
            match read_text(&path, self.max_size) {
                Err(Unreadable::Missing | Unreadable::NotAFile(_)) => {}
                Err(cause) => return Err(Error::new(why(&path, cause))),
                Ok(text) => return self.open_text(name, path, text),
            }
        }
        Err(Error::file_not_found(name))
    }
}

impl Disk {
    fn open_text(&self, name: &str, path: PathBuf, text: String) -> Result<File, Error> {
        // Strip the byte order mark, so that the compiler's positions agree with those of `Sources`.
        let text = text.trim_start_matches('\u{feff}').to_owned();
        if let Some(why) = limits::exceeded(&text) {
            return Err(Error::new(why));
        }
        if let Some(other) = self.other_name(name, &path) {
            return Err(Error::new(format!(
                "`{name}` and `{other}` are the same file; use one of the two names everywhere"
            )));
        }
        let Imported { mut mistakes, files } = look_up(&text, &path, &self.folders);
        mistakes.extend(edition::find(&text, self.folders.relative(&path)));
        let parsed = match mistakes.as_slice() {
            [] => File::from_source(name, &text),
            [first, ..] => Err(Error::new(first.message.clone())),
        };
        let mut seen = self.seen.get();
        seen.mistakes.extend(mistakes);
        seen.imported.extend(files);
        seen.files.push(SchemaFile { name: name.to_owned(), path, text });
        parsed
    }

    /// The other name under which the compiler already knows a file: its messages would be declared twice.
    fn other_name(&self, name: &str, path: &Path) -> Option<String> {
        let path = path.canonicalize().ok()?;
        let seen = self.seen.get();
        let same = |file: &&SchemaFile| file.name != name && file.path.canonicalize().is_ok_and(|other| other == path);
        seen.files.iter().find(same).map(|file| file.name.clone())
    }
}
