//! What to load, and how messages call it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

/// Which file to load.
#[derive(Debug, Clone)]
pub struct Request {
    /// The path to read.
    pub path: PathBuf,
    /// The kind of the file, as messages call it: `topology` by default.
    pub kind: &'static str,
    /// How messages name the file, for example relative to the working folder.
    pub shown_as: String,
    /// Maximum size in bytes of the topology file, and of each schema. [`Request::MAX_SIZE`] by default.
    pub max_size: u64,
    /// Texts to check in place of included files on disk, by their paths: changes that are not saved.
    pub texts: BTreeMap<PathBuf, String>,
    /// Every place where the file was searched for, to be listed if it is not found.
    pub looked_in: Vec<LookedIn>,
    /// The crates that a Rust program with this topology can name; the module of a schema's package may hide one. By
    /// default, those that every program has.
    pub crates: BTreeSet<String>,
}

/// One place in which a file was looked for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LookedIn {
    /// The path that would have been read.
    pub path: PathBuf,
    /// How messages name it.
    pub shown_as: String,
    /// Which place that is: `next to this source file`; may be empty.
    pub what: String,
}

impl Request {
    /// The default limit of a file's size: 1 MiB.
    pub const MAX_SIZE: u64 = 1024 * 1024;

    /// A request for the file at `path`, which messages call by that path.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        let path = path.into();
        let shown_as = path.display().to_string();
        let crates = ["alloc", "core", "scl", "std"].map(str::to_owned).into();
        let (texts, looked_in) = (BTreeMap::new(), Vec::new());
        Self { path, kind: "topology", shown_as, max_size: Self::MAX_SIZE, texts, looked_in, crates }
    }

    /// The system's name if the file gives none: the file's name without its ending.
    pub(crate) fn default_system(&self) -> String {
        self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    }
}
