//! Exclusive locks on files, between processes and within one.
//!
//! Between processes these are POSIX record locks, because forked children do not inherit them: a child that outlives a
//! killed parent does not keep the parent's lock, as it would with `flock`. Their two defects are handled here. They do
//! not exclude a second lock by the same process, so the process keeps a list of the locks it holds. And closing *any*
//! descriptor of the file releases the lock, so a file on the list is never opened again. Other code in the process
//! must not open it either; there is nothing to read in it.
//!
//! A process may contain several copies of this library, for example in two plugins, and each has a list of its own.
//! The operating system tells which descriptor a lock was taken through: the second lock on a file leaves the first as
//! it is. A copy that finds the file locked through another's descriptor keeps its own open, so that the lock stays.

use super::error::ComponentProcess;
use crate::sync::lock;
use rustix::fs::{FlockOperation, OFlags};
use rustix::io::Errno;
use rustix::process::{Flock, FlockType, fcntl_getlk};
use scl_fork::ProcessMark;
use std::fs::{self, File, Metadata, OpenOptions};
use std::io;
use std::os::fd::{AsRawFd, RawFd};
use std::os::unix::fs::{MetadataExt, OpenOptionsExt};
use std::path::Path;
use std::sync::Mutex;

/// Maximum number of attempts to lock a file that is removed or unlocked at the same time.
const ATTEMPTS: usize = 100;

/// The files that must stay open. A forked child keeps those of its parent open, too: closing one would release a lock
/// that the child itself has since taken on the same file.
static OPEN: Mutex<Vec<OpenFile>> = Mutex::new(Vec::new());

struct OpenFile {
    id: FileId,
    process: ProcessMark,
    file: File,
    /// Another descriptor of the file, which must stay open as well.
    read_only: Option<File>,
    /// Whether it is locked by this copy of the library, and not by another one in the process.
    locked: bool,
}

/// Flags for opening files: links are not followed, and opening does not wait at pipes.
const FLAGS: OFlags = OFlags::NOFOLLOW.union(OFlags::NONBLOCK);

impl OpenFile {
    /// Opens the file for writing as well: it stays open, and locking it later requires that.
    fn make_writable(&mut self, path: &Path) {
        let mut options = OpenOptions::new();
        options.read(true).write(true).custom_flags(FLAGS.bits().cast_signed());
        if self.read_only.is_some() || !FileId::at(path).is_ok_and(|id| id == self.id) {
            return;
        }
        if let Ok(file) = options.open(path) {
            self.read_only = Some(std::mem::replace(&mut self.file, file));
        }
    }
}

/// Identifies a file, also after it was renamed or removed, for as long as it is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FileId {
    device: u64,
    inode: u64,
}

impl FileId {
    /// Identifies the file that has this path now. Does not follow links.
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
    Held(ComponentProcess),
}

/// Locks the file at `path` without waiting, creating it with mode 0600 if necessary.
pub(super) fn try_lock(path: &Path) -> io::Result<Attempt> {
    try_lock_with(path, &mut |_| {})
}

/// Releases a lock of this process. Does nothing in a forked child.
pub(super) fn unlock(id: FileId) {
    lock(&OPEN).retain(|open| open.id != id || !open.locked || !open.process.is_own());
}

/// Returns the process that holds the lock on the file at `path`, if any.
pub(super) fn lock_holder(path: &Path) -> Option<ComponentProcess> {
    let mut open = lock(&OPEN);
    // Open it for reading only: programs that watch the folder take a `CLOSE_WRITE` event of a lock file for the end of
    // its component.
    let index = match open_once(path, OpenOptions::new().read(true), &mut open, &mut |_| {}).ok()? {
        Opened::At(index) => index,
        Opened::LockedHere => return Some(ComponentProcess::ThisProcess),
    };
    let holder = other_holder(&open[index].file).ok().flatten();
    if holder.is_none() && is_locked_by_another_copy(open[index].id) {
        open[index].make_writable(path);
        return Some(ComponentProcess::ThisProcess);
    }
    open.swap_remove(index);
    holder
}

/// Steps of [`try_lock`] after which tests intervene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Examined,
    Opened,
}

fn try_lock_with(path: &Path, step: &mut dyn FnMut(Step)) -> io::Result<Attempt> {
    let mut open = lock(&OPEN);
    for _ in 0..ATTEMPTS {
        let mut options = OpenOptions::new();
        options.read(true).write(true).create(true).truncate(false).mode(0o600);
        let Opened::At(index) = open_once(path, &mut options, &mut open, step)? else {
            return Ok(Attempt::Held(ComponentProcess::ThisProcess));
        };
        let OpenFile { id, file, .. } = &open[index];
        let id = *id;
        if !file.metadata()?.is_file() {
            open.swap_remove(index);
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is not a regular file"));
        }
        step(Step::Opened);
        match rustix::fs::fcntl_lock(file, FlockOperation::NonBlockingLockExclusive) {
            // The lock is worthless if the file was removed or replaced in the meantime: other processes would lock the
            // new one.
            Ok(()) if FileId::at(path).is_ok_and(|now| now == id) => {
                if !has_lock(file.as_raw_fd()) && is_locked_by_another_copy(id) {
                    return Ok(Attempt::Held(ComponentProcess::ThisProcess));
                }
                open[index].locked = true;
                return Ok(Attempt::Locked(id));
            }
            Ok(()) => {}
            Err(Errno::AGAIN | Errno::ACCESS) => {
                // None if it was unlocked in the meantime.
                if let Some(holder) = other_holder(file)? {
                    open.swap_remove(index);
                    return Ok(Attempt::Held(holder));
                }
            }
            Err(error) => {
                open.swap_remove(index);
                return Err(error.into());
            }
        }
        open.swap_remove(index);
    }
    Err(io::Error::other("the file is replaced again and again"))
}

enum Opened {
    /// The index in the list of a file that this copy has not locked. The caller removes it unless another copy has
    /// locked it.
    At(usize),
    LockedHere,
}

/// Opens a file unless it is open. Does not follow links, and does not wait at pipes.
fn open_once(
    path: &Path,
    options: &mut OpenOptions,
    open: &mut Vec<OpenFile>,
    step: &mut dyn FnMut(Step),
) -> io::Result<Opened> {
    if let Some(found) = FileId::at(path).ok().and_then(|id| find(open, id)) {
        return Ok(found);
    }
    step(Step::Examined);
    let file = options.custom_flags(FLAGS.bits().cast_signed()).open(path)?;
    let id = FileId::of(&file.metadata()?);
    if let Some(found) = find(open, id) {
        // An open file was renamed to `path` just now. Closing this descriptor would release the lock on it.
        std::mem::forget(file);
        return Ok(found);
    }
    open.push(OpenFile { id, process: ProcessMark::new(), file, read_only: None, locked: false });
    Ok(Opened::At(open.len() - 1))
}

fn find(open: &[OpenFile], id: FileId) -> Option<Opened> {
    let index = open.iter().position(|open| open.id == id && open.process.is_own())?;
    Some(if open[index].locked { Opened::LockedHere } else { Opened::At(index) })
}

/// Returns true if this process holds the lock on a file through a descriptor that this copy of the library has not
/// locked.
fn is_locked_by_another_copy(id: FileId) -> bool {
    let Ok(descriptors) = fs::read_dir("/proc/thread-self/fd") else { return false };
    descriptors.flatten().any(|descriptor| {
        let number = descriptor.file_name().to_str().and_then(|name| name.parse().ok());
        fs::metadata(descriptor.path()).is_ok_and(|found| FileId::of(&found) == id) && number.is_some_and(has_lock)
    })
}

/// Returns true if this process has locked a file through this descriptor.
fn has_lock(descriptor: RawFd) -> bool {
    let about = fs::read_to_string(format!("/proc/thread-self/fdinfo/{descriptor}")).unwrap_or_default();
    about.lines().any(|line| line.starts_with("lock:") && line.contains("POSIX"))
}

fn other_holder(file: &File) -> io::Result<Option<ComponentProcess>> {
    let lock = fcntl_getlk(file, &Flock::from(FlockType::WriteLock))?;
    let process = |pid: rustix::process::Pid| ComponentProcess::Process(pid.as_raw_nonzero().get().cast_unsigned());
    Ok(lock.map(|lock| lock.pid.map_or(ComponentProcess::Unknown, process)))
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
            assert_eq!(lock_holder(&path), Some(ComponentProcess::ThisProcess));
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
        assert_eq!(try_lock_with(&path, &mut rename).unwrap(), Attempt::Held(ComponentProcess::ThisProcess));
        assert!(is_locked(id));
        assert_eq!(try_lock(&path).unwrap(), Attempt::Held(ComponentProcess::ThisProcess));
        assert_eq!(lock_holder(&path), Some(ComponentProcess::ThisProcess));
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
            assert_eq!(try_lock(&path).unwrap(), Attempt::Held(ComponentProcess::ThisProcess));
            assert_eq!(lock_holder(&path), Some(ComponentProcess::ThisProcess));
        }
        let open = fs::read_dir("/proc/self/fd").unwrap().flatten();
        let open = open.filter(|descriptor| fs::read_link(descriptor.path()).is_ok_and(|file| file == path));
        assert_eq!(open.count(), 1);
        unlock(id);
    }

    #[test]
    fn a_lock_of_another_copy_of_the_library_is_respected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        let id = |file: &File| FileId::of(&file.metadata().unwrap());
        // Each copy has its own list, so a lock that is on no list is that of another copy.
        let other = File::create(&path).unwrap();
        rustix::fs::fcntl_lock(&other, FlockOperation::NonBlockingLockExclusive).unwrap();
        for _ in 0..3 {
            assert_eq!(lock_holder(&path), Some(ComponentProcess::ThisProcess));
            assert_eq!(try_lock(&path).unwrap(), Attempt::Held(ComponentProcess::ThisProcess));
            assert!(is_locked(id(&other)), "looking at it does not release it");
        }
        drop(other);
        assert_eq!(lock_holder(&path), None);
        let Attempt::Locked(id) = try_lock(&path).unwrap() else { panic!("the lock is free") };
        assert!(is_locked(id));
        unlock(id);
        assert!(!is_locked(id));
    }

    #[tokio::test]
    async fn looking_at_a_lock_is_not_taken_for_the_end_of_a_component() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sensor.lock");
        File::create(&path).unwrap();
        let inotify = crate::runtime_dir::Inotify::new().unwrap();
        inotify.watch(folder.path(), rustix::fs::inotify::WatchFlags::CLOSE_WRITE).unwrap();
        assert_eq!(lock_holder(&path), None);
        assert!(inotify.read_now(|_| ()).is_err(), "the descriptor was writable");
    }

    /// Whether the operating system knows of a lock of this process on a file.
    ///
    /// Not from `/proc/locks`: it is read in several steps, and misses a lock if others come and go between them.
    fn is_locked(id: FileId) -> bool {
        let descriptors = fs::read_dir("/proc/self/fdinfo").unwrap().flatten();
        // Other tests close descriptors meanwhile.
        let mut infos = descriptors.filter_map(|descriptor| fs::read_to_string(descriptor.path()).ok());
        infos.any(|info| {
            let mut locks = info.lines().filter(|line| line.starts_with("lock:") && line.contains(" POSIX "));
            locks.any(|lock| lock.contains(&format!(":{} ", id.inode)))
        })
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
