//! Files that a killed program had created, but not yet given a length.
//!
//! The engine takes an empty file for one that another program is creating, and waits for it without a limit.

use crate::error::ShmError;
use crate::folder::Folder;
use std::fs;
use std::path::PathBuf;
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

/// A file that is found empty twice, this long apart, is abandoned: a living program needs some microseconds.
const ABANDONED: Duration = Duration::from_millis(200);

/// Runs `work`, in which the engine opens files of killed programs, and removes abandoned ones until it is done. The
/// engine then continues without them.
pub(crate) fn removing<T>(folder: &Folder, work: impl FnOnce() -> Result<T, ShmError>) -> Result<T, ShmError> {
    let (working, end) = mpsc::channel::<()>();
    thread::scope(|scope| {
        let remove = move || {
            let mut empty = Vec::new();
            while end.recv_timeout(ABANDONED) == Err(RecvTimeoutError::Timeout) {
                empty = remove_those_that_stay(folder, &empty);
            }
        };
        thread::Builder::new()
            .name("scl-shm-remove".to_owned())
            .spawn_scoped(scope, remove)
            .map_err(|source| ShmError::Thread { source })?;
        // Dropped even if `work` panics, so that the thread ends.
        let _working = working;
        work()
    })
}

/// Removes the files that are still empty, and returns those that are newly empty.
fn remove_those_that_stay(folder: &Folder, were_empty: &[PathBuf]) -> Vec<PathBuf> {
    let is_empty = |path: &PathBuf| fs::symlink_metadata(path).is_ok_and(|found| found.len() == 0);
    let (stay, are_new): (Vec<_>, Vec<_>) = folder.files().filter(is_empty).partition(|path| were_empty.contains(path));
    for path in stay {
        // A file that cannot be removed now counts as new the next time.
        let _stays = fs::remove_file(path);
    }
    are_new
}
