//! What one test at a time does, also of tests that are processes of their own.

use std::fs::File;
use std::path::Path;

/// Locks a file, which it creates if need be, until the result is dropped. A test that fails, or is killed, does not
/// keep others out.
///
/// # Panics
/// If the file cannot be created.
#[must_use = "it is locked as long as this exists"]
pub fn lock_file(path: &Path) -> File {
    let file = File::create(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    file.lock().unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    file
}
