use std::{
    fs, io,
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
    time::{Duration, SystemTime},
};

use super::{claim::Claim, error::PlaceError};

/// The bytes that a temporary name takes: a full stop and six digits.
pub(super) const NAME_BYTES: usize = 7;

/// A draft exists for microseconds; one that is older belongs to a program that was killed. An age tells this also where
/// several containers with process numbers of their own share the folder.
const STALE_AFTER: Duration = Duration::from_secs(60);

/// How many taken names are passed over; each was left behind by a killed program, or is in use at this moment.
const ATTEMPTS: usize = 64;

static NEXT: AtomicU32 = AtomicU32::new(0);

/// Something made under a temporary name in the folder where it will be needed; removed unless it is put in place.
#[derive(Debug)]
pub(super) struct Draft {
    path: PathBuf,
    placed: bool,
}

impl Draft {
    /// Makes something under a free temporary name. `make` must fail when the name is taken.
    pub(super) fn create<T>(folder: &Path, mut make: impl FnMut(&Path) -> io::Result<T>) -> io::Result<(Self, T)> {
        let mut attempts = 0;
        loop {
            let path = folder.join(temporary_name());
            attempts += 1;
            match make(&path) {
                Ok(made) => return Ok((Self { path, placed: false }, made)),
                Err(error) if is_taken(&error) && attempts < ATTEMPTS => {}
                Err(error) => return Err(error),
            }
        }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Gives it its final name, in place of whatever has that name.
    pub(super) fn place(mut self, path: &Path) -> Result<Claim, PlaceError> {
        let claim = Claim::on(&self.path, path).map_err(|error| PlaceError::io("look at", &self.path, error))?;
        fs::rename(&self.path, path).map_err(|error| PlaceError::io("put in place", path, error))?;
        self.placed = true;
        Ok(claim)
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Once it is in place its temporary name may already be another program's.
        if !self.placed {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Removes the drafts of killed programs. What cannot be removed does no harm.
pub(super) fn sweep_drafts(folder: &Path, now: SystemTime) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let stale = || {
            let changed = entry.metadata().and_then(|seen| seen.modified()).ok()?;
            Some(now.duration_since(changed).ok()? > STALE_AFTER)
        };
        if entry.file_name().as_encoded_bytes().starts_with(b".") && stale() == Some(true) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// Short, because a socket's path must fit a socket address under this name too. Another process may hit on the same name:
/// `make` then finds it taken. Starting from the process number makes that rare.
fn temporary_name() -> String {
    let start = std::process::id().wrapping_mul(0x9e37_79b1) >> 8;
    let number = start.wrapping_add(NEXT.fetch_add(1, Ordering::Relaxed));
    format!(".{:06x}", number & 0xff_ffff)
}

fn is_taken(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::AlreadyExists | io::ErrorKind::AddrInUse)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    fn write(path: &Path) -> io::Result<fs::File> {
        fs::File::create_new(path)
    }

    fn names(folder: &Path) -> usize {
        fs::read_dir(folder).unwrap().count()
    }

    #[test]
    fn a_draft_goes_away_unless_it_is_put_in_place() {
        let folder = tempfile::tempdir().unwrap();
        let (draft, _) = Draft::create(folder.path(), write).unwrap();
        assert_eq!(draft.path().file_name().unwrap().len(), NAME_BYTES);
        drop(draft);
        assert_eq!(names(folder.path()), 0);
    }

    #[test]
    fn taken_names_are_passed_over_but_not_for_ever() {
        let folder = tempfile::tempdir().unwrap();
        let mut calls = 0;
        let mut taken = |limit| {
            calls = 0;
            Draft::create(folder.path(), |path| {
                calls += 1;
                if calls < limit { Err(io::ErrorKind::AddrInUse.into()) } else { write(path) }
            })
            .is_ok()
        };
        assert!(taken(ATTEMPTS));
        assert!(!taken(ATTEMPTS + 1));
    }

    #[test]
    fn only_old_drafts_are_swept() {
        let folder = tempfile::tempdir().unwrap();
        for name in [".00000a", "sensor.lock"] {
            write(&folder.path().join(name)).unwrap();
        }
        let made = SystemTime::now();
        sweep_drafts(folder.path(), made + STALE_AFTER / 2);
        assert_eq!(names(folder.path()), 2);
        sweep_drafts(folder.path(), made + STALE_AFTER * 2);
        assert_eq!(names(folder.path()), 1);
        assert!(folder.path().join("sensor.lock").exists());
    }
}
