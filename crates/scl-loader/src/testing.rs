//! Folders with files, for the tests.

use crate::{Loaded, Request, load};
use std::fs;
use tempfile::TempDir;

/// A fresh folder with these files.
pub(crate) fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
    folder
}

/// Loads a file of the folder under its plain name.
pub(crate) fn load_from(folder: &TempDir, name: &str) -> Loaded {
    let shown_as = name.to_owned();
    load(&Request { shown_as, ..Request::new(folder.path().join(name)) })
}
