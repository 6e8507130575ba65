//! Exclusive locks on files, between processes and within one.
//!
//! Between processes these are POSIX record locks, because forked children do not inherit them: a child that outlives a
//! killed parent does not keep the parent's lock, as it would with `flock`. Their two defects are handled here. They do
//! not exclude a second lock by the same process, so the process keeps a list of the locks it holds. And closing *any*
//! descriptor of the file releases the lock, so a file on the list is never opened again. Other code in the process
//! must not open it either; there is nothing to read in it.

use crate::process_mark::ProcessMark;
use crate::sync::lock;
use rustix::fs::{FlockOperation, OFlags};
use rustix::io::Errno;
use rustix::process::{Flock, FlockType, fcntl_getlk};
use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::sync::Mutex;

/// Attempts to lock a file that is removed or unlocked just at that moment.
const ATTEMPTS: usize = 100;

/// The locks of this process. In a forked child they are those of its parent, and must stay open: closing one would
/// release a lock that the child itself has taken on the same file since.
static HELD: Mutex<Vec<HeldLock>> = Mutex::new(Vec::new());

struct HeldLock {
    id: FileId,
    process: ProcessMark,
    _file: File,
}

/// Identifies a file, also after it was renamed or removed, for as long as it is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FileId {
    device: u64,
    inode: u64,
}

impl FileId {
    /// The file that has this path now. Does not follow links.
    pub(super) fn at(path: &Path) -> io::Result<Self> {
        fs::symlink_metadata(path).map(|found| Self::of(&found))
    }

    fn of(found: &Metadata) -> Self {
        Self { device: found.dev(), inode: found.ino() }
    }
}

/// A successful or refused attempt to lock a file.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Attempt {
    /// The file is locked now, until [`unlock`].
    Locked(FileId),
    Held(LockHolder),
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LockHolder {
    ThisProcess,
    /// Another process; `None` if it is not visible from here, as in another container.
    Process(Option<u32>),
}

/// Locks the file at `path` without waiting, creating it with mode 0600 if necessary.
pub(super) fn try_lock(path: &Path) -> io::Result<Attempt> {
    try_lock_with(path, &mut |_| {})
}

/// Releases a lock of this process. Does nothing in a forked child.
pub(super) fn unlock(id: FileId) {
    lock(&HELD).retain(|held| held.id != id || !held.process.is_own());
}

/// Who holds the lock on the file at `path`, if any process does.
pub(super) fn lock_holder(path: &Path) -> Option<LockHolder> {
    match open(path, OpenOptions::new().read(true), &lock(&HELD), &mut |_| {}).ok()? {
        Opened::Other(file) => other_holder(&file).ok()?,
        Opened::HeldHere => Some(LockHolder::ThisProcess),
    }
}

/// Steps of [`try_lock`] between which tests intervene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Examined,
    Opened,
}

fn try_lock_with(path: &Path, step: &mut dyn FnMut(Step)) -> io::Result<Attempt> {
    let mut held = lock(&HELD);
    for _ in 0..ATTEMPTS {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false).mode(0o600);
        let Opened::Other(file) = open(path, &mut options, &held, step)? else {
            return Ok(Attempt::Held(LockHolder::ThisProcess));
        };
        let found = file.metadata()?;
        if !found.is_file() {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
        }
        let id = FileId::of(&found);
        step(Step::Opened);
        match rustix::fs::fcntl_lock(&file, FlockOperation::NonBlockingLockExclusive) {
            // A file that was removed or replaced in the meantime excludes nobody.
            Ok(()) if FileId::at(path).is_ok_and(|now| now == id) => {
                held.push(HeldLock { id, process: ProcessMark::new(), _file: file });
                return Ok(Attempt::Locked(id));
            }
            Ok(()) => {}
            Err(Errno::AGAIN | Errno::ACCESS) => {
                // None if it was unlocked in the meantime.
                if let Some(holder) = other_holder(&file)? {
                    return Ok(Attempt::Held(holder));
                }
            }
            Err(error) => return Err(error.into()),
        }
    }
    Err(io::Error::other("the file is replaced again and again"))
}

enum Opened {
    /// A file that this process has not locked.
    Other(File),
    HeldHere,
}

/// Opens a file unless this process has locked it. Does not follow links, and does not wait at pipes.
fn open(path: &Path, options: &mut OpenOptions, held: &[HeldLock], step: &mut dyn FnMut(Step)) -> io::Result<Opened> {
    let is_held = |id| held.iter().any(|held| held.id == id && held.process.is_own());
    if FileId::at(path).is_ok_and(is_held) {
        return Ok(Opened::HeldHere);
    }
    step(Step::Examined);
    let file = options.custom_flags((OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed()).open(path)?;
    if is_held(FileId::of(&file.metadata()?)) {
        // It was renamed to `path` just now. Closing it would release the lock.
        std::mem::forget(file);
        return Ok(Opened::HeldHere);
    }
    Ok(Opened::Other(file))
}

fn other_holder(file: &File) -> io::Result<Option<LockHolder>> {
    let lock = fcntl_getlk(file, &Flock::from(FlockType::WriteLock))?;
    let pid = |lock: Flock| lock.pid.map(|pid| pid.as_raw_nonzero().get().cast_unsigned());
    Ok(lock.map(|lock| LockHolder::Process(pid(lock))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_is_removed_or_replaced_before_it_is_locked_is_not_taken() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        let changes: [&dyn Fn(); 3] = [
            &|| fs::remove_file(&path).unwrap(),
            &|| {
                fs::remove_file(&path).unwrap();
                fs::write(&path, "").unwrap();
            },
            &|| fs::rename(&path, folder.path().join("old")).unwrap(),
        ];
        for change in changes {
            let mut opened = 0;
            let locked = try_lock_with(&path, &mut |step| {
                opened += usize::from(step == Step::Opened);
                if (step, opened) == (Step::Opened, 1) {
                    change();
                }
            });
            assert_eq!(opened, 2);
            let Attempt::Locked(id) = locked.unwrap() else { panic!("the lock is free") };
            assert_eq!(FileId::at(&path).unwrap(), id);
            assert_eq!(lock_holder(&path), Some(LockHolder::ThisProcess));
            unlock(id);
            assert_eq!(lock_holder(&path), None);
        }
    }

    #[test]
    fn a_file_that_is_replaced_again_and_again_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        let mut remove = |step| {
            if step == Step::Opened {
                fs::remove_file(&path).unwrap();
            }
        };
        let error = try_lock_with(&path, &mut remove).unwrap_err();
        assert_eq!(error.to_string(), "the file is replaced again and again");
    }

    #[test]
    fn a_held_file_stays_locked_under_another_name() {
        let folder = tempfile::tempdir().unwrap();
        let [held, path] = ["held.lock", "sensor.lock"].map(|name| folder.path().join(name));
        let Attempt::Locked(id) = try_lock(&held).unwrap() else { panic!("the lock is free") };
        // Renamed just before it is opened, so that it must not be closed, and before it is looked at.
        let mut rename = |step| {
            if step == Step::Examined {
                fs::rename(&held, &path).unwrap();
            }
        };
        assert_eq!(try_lock_with(&path, &mut rename).unwrap(), Attempt::Held(LockHolder::ThisProcess));
        assert!(is_locked(id));
        assert_eq!(try_lock(&path).unwrap(), Attempt::Held(LockHolder::ThisProcess));
        assert_eq!(lock_holder(&path), Some(LockHolder::ThisProcess));
        assert!(is_locked(id));
        unlock(id);
        assert!(!is_locked(id));
        let Attempt::Locked(id) = try_lock(&path).unwrap() else { panic!("the lock is free") };
        unlock(id);
    }

    #[test]
    fn a_lock_file_is_private_and_refusing_it_leaks_no_descriptor() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        let Attempt::Locked(id) = try_lock(&path).unwrap() else { panic!("the lock is free") };
        assert_eq!(fs::metadata(&path).unwrap().mode() & 0o7777, 0o600);
        for _ in 0..10 {
            assert_eq!(try_lock(&path).unwrap(), Attempt::Held(LockHolder::ThisProcess));
            assert_eq!(lock_holder(&path), Some(LockHolder::ThisProcess));
        }
        let open = fs::read_dir("/proc/self/fd").unwrap().flatten();
        let open = open.filter(|descriptor| fs::read_link(descriptor.path()).is_ok_and(|file| file == path));
        assert_eq!(open.count(), 1);
        unlock(id);
    }

    /// Whether the operating system knows of a lock on a file.
    fn is_locked(id: FileId) -> bool {
        let locks = fs::read_to_string("/proc/locks").unwrap();
        locks.lines().any(|line| line.contains(" POSIX ") && line.contains(&format!(":{} ", id.inode)))
    }

    #[test]
    fn only_regular_files_are_locked() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        rustix::fs::mknodat(rustix::fs::CWD, &path, rustix::fs::FileType::Fifo, 0o600.into(), 0).unwrap();
        assert_eq!(try_lock(&path).unwrap_err().to_string(), "it is not a regular file");
        assert_eq!(lock_holder(&path), None);
        fs::remove_file(&path).unwrap();
        std::os::unix::fs::symlink(folder.path().join("target"), &path).unwrap();
        assert!(try_lock(&path).is_err());
        assert!(!folder.path().join("target").exists());
    }
}
