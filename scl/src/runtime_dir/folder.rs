//! The runtime folder and the folders of systems: finding them, creating them, and verifying that they are safe.

use super::SOCKET_PATH_LIMIT;
#[cfg(feature = "protobuf")]
use super::compared::Compared;
use super::error::RuntimeDirError;
use super::event_count::{EventCount, Seen};
use super::temp_entry::{NAME_BYTES, remove_stale_entries};
use scl_text::gate_name::{from_file_name, in_file_name};
use std::ffi::OsString;
use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::{DirBuilderExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll};
use std::time::SystemTime;

/// The endings of SCL's own files. An endpoint with one of them would replace such a file.
const RESERVED: [&str; 6] = [".lock", ".json", ".tcp", ".schema", ".stats", ".values"];

/// The runtime folder, which contains a folder for each system. It is verified to be safe from other users.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RuntimeDir {
    path: PathBuf,
    /// Whether it was chosen by `SCL_RUNTIME_DIR`: then parents are created too, and other users may read. By default,
    /// only this user has access.
    is_chosen: bool,
}

impl RuntimeDir {
    /// Finds, creates and verifies the runtime folder.
    ///
    /// It is the first of these that applies: `$SCL_RUNTIME_DIR`; `scl` in `$XDG_RUNTIME_DIR` if that is a folder of
    /// this user; `scl-<uid>` in `$TMPDIR`, else in `/tmp`. Empty variables count as unset, as do relative paths in
    /// `XDG_RUNTIME_DIR` and `TMPDIR`. Missing folders are created with mode 0700. The path must lead to a folder, not
    /// to a link, that belongs to this user. Other users may read but not write to the one from `$SCL_RUNTIME_DIR`, and
    /// have no access to the other two.
    ///
    /// `env` returns the value of a variable: `&|name| std::env::var_os(name)`.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError`] if the folder cannot be created or is not safe. The next candidate is not tried then,
    /// because components that fall back to different folders would never find each other.
    pub fn locate(env: &dyn Fn(&str) -> Option<OsString>) -> Result<Self, RuntimeDirError> {
        let dir = Self::choose(env)?;
        dir.create()?;
        Ok(dir)
    }

    /// Finds and verifies the runtime folder as [`locate`](Self::locate) does, but creates nothing: `None` if it does
    /// not exist.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError`] if the folder is not safe or cannot be examined.
    pub fn existing(env: &dyn Fn(&str) -> Option<OsString>) -> Result<Option<Self>, RuntimeDirError> {
        let dir = Self::choose(env)?;
        Ok(verify_existing(&dir.path, dir.is_chosen)?.then_some(dir))
    }

    fn choose(env: &dyn Fn(&str) -> Option<OsString>) -> Result<Self, RuntimeDirError> {
        let variable = |name| env(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let absolute = |name| variable(name).filter(|path| path.is_absolute());
        let (path, is_chosen) = if let Some(path) = variable("SCL_RUNTIME_DIR") {
            if !path.is_absolute() {
                return Err(RuntimeDirError::RelativeFolder { variable: "SCL_RUNTIME_DIR", path });
            }
            // Removes a trailing slash, which would make the verification follow a symbolic link.
            (path.components().collect(), true)
        } else if let Some(session) = absolute("XDG_RUNTIME_DIR").filter(|path| is_own_folder(path)) {
            (session.join("scl"), false)
        } else {
            let temporary = absolute("TMPDIR").unwrap_or_else(|| "/tmp".into());
            (temporary.join(format!("scl-{}", own_user())), false)
        };
        Ok(Self { path, is_chosen })
    }

    /// Returns its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Creates and verifies the folder of a system, and removes temporary files that killed processes left there.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError`] if the name cannot be the name of a folder, or the folder cannot be created or is not safe.
    pub fn system(&self, name: &str) -> Result<SystemDir, RuntimeDirError> {
        let dir = self.system_dir(name)?;
        dir.create()?;
        remove_stale_entries(&dir.path, SystemTime::now());
        Ok(dir)
    }

    /// Returns the folder of a system, verified as [`system`](Self::system) does, or `None` if it does not exist.
    /// Creates nothing and removes nothing.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError`] if the name cannot be the name of a folder, or the folder is not safe.
    pub fn existing_system(&self, name: &str) -> Result<Option<SystemDir>, RuntimeDirError> {
        let dir = self.system_dir(name)?;
        Ok(verify_existing(&dir.path, false)?.then_some(dir))
    }

    fn system_dir(&self, name: &str) -> Result<SystemDir, RuntimeDirError> {
        let path = self.path.join(plain("a system", name)?);
        let shared = Shared {
            runtime_dir: self.clone(),
            restored: EventCount::default(),
            arrived: EventCount::default(),
            watches: AtomicUsize::new(0),
            #[cfg(feature = "protobuf")]
            compared: Compared::default(),
        };
        Ok(SystemDir { path, shared: Arc::new(shared) })
    }

    fn create(&self) -> Result<(), RuntimeDirError> {
        create_folder(&self.path, self.is_chosen)
    }
}

/// The folder where the components of one system find each other.
#[derive(Debug, Clone)]
pub struct SystemDir {
    path: PathBuf,
    shared: Arc<Shared>,
}

#[derive(Debug)]
struct Shared {
    runtime_dir: RuntimeDir,
    restored: EventCount,
    arrived: EventCount,
    /// Number of watches of the folder that report arriving files.
    watches: AtomicUsize,
    #[cfg(feature = "protobuf")]
    compared: Compared,
}

impl SystemDir {
    /// Returns its path.
    pub fn folder(&self) -> &Path {
        &self.path
    }

    /// Returns the path of an endpoint's socket.
    ///
    /// # Errors
    ///
    /// [`RuntimeDirError::PathTooLong`] if it does not fit a socket address; [`RuntimeDirError::BadName`] and
    /// [`RuntimeDirError::ReservedName`] if the endpoint cannot be the name of a socket.
    pub fn path(&self, endpoint: &str) -> Result<PathBuf, RuntimeDirError> {
        if let Some(ending) = RESERVED.into_iter().find(|ending| endpoint.ends_with(ending)) {
            return Err(RuntimeDirError::ReservedName { endpoint: endpoint.to_owned(), ending });
        }
        // In names of files, `+` stands for the dots in the name of a component.
        let path = self.path.join(endpoint);
        plain("an endpoint", &from_file_name(endpoint))?;
        // The socket is bound under a temporary name, which may be the longer of the two.
        let name = endpoint.len().max(NAME_BYTES);
        let length = self.path.as_os_str().as_bytes().len() + 1 + name;
        if length > SOCKET_PATH_LIMIT {
            let system = self.path.file_name().map_or(0, |name| name.as_bytes().len());
            let room = SOCKET_PATH_LIMIT.saturating_sub(system + name + 2);
            return Err(RuntimeDirError::PathTooLong { path, length, room });
        }
        Ok(path)
    }

    /// Returns the path of one of a component's own files; `ending` starts with a full stop.
    pub(super) fn file_of(&self, component: &str, ending: &str) -> Result<PathBuf, RuntimeDirError> {
        Ok(self.path.join(format!("{}{ending}", in_file_name(plain("a component", component)?))))
    }

    pub(super) fn schema_file(&self, hash: &str) -> Result<PathBuf, RuntimeDirError> {
        Ok(self.path.join(format!("{}.schema", plain("a schema", hash)?)))
    }

    /// Returns the path of the runtime folder, which contains this folder.
    pub(super) fn runtime_folder(&self) -> &Path {
        &self.shared.runtime_dir.path
    }

    /// Ready when the folder, or a file in it, was restored since `seen`, which is updated then: listening ends whose
    /// socket is gone bind it again. Otherwise registers the task's waker.
    #[cfg_attr(not(feature = "zeromq"), expect(dead_code, reason = "only that transport has sockets"))]
    pub(crate) fn poll_restored(&self, seen: &mut Seen, cx: &mut Context<'_>) -> Poll<()> {
        self.shared.restored.poll(seen, cx)
    }

    /// Wakes the tasks that wait in [`poll_restored`](Self::poll_restored) of any clone of this value.
    pub(crate) fn mark_restored(&self) {
        self.shared.restored.mark();
    }

    /// Ready when a file has arrived in the folder since `seen`, which is updated then. Otherwise registers the task's
    /// waker. Arrivals are reported only while [`reports_arrivals`](Self::reports_arrivals) returns true.
    #[cfg_attr(not(feature = "zeromq"), expect(dead_code, reason = "only that transport has sockets"))]
    pub(crate) fn poll_arrived(&self, seen: &mut Seen, cx: &mut Context<'_>) -> Poll<()> {
        self.shared.arrived.poll(seen, cx)
    }

    /// Returns true if the folder is watched for arriving files.
    #[cfg_attr(not(feature = "zeromq"), expect(dead_code, reason = "only that transport has sockets"))]
    pub(crate) fn reports_arrivals(&self) -> bool {
        self.shared.watches.load(Ordering::SeqCst) > 0
    }

    /// Wakes the tasks that wait in [`poll_arrived`](Self::poll_arrived) of any clone of this value.
    pub(crate) fn mark_arrived(&self) {
        self.shared.arrived.mark();
    }

    /// Counts a watch that begins or ends. Files that arrived unnoticed before count as arrived now.
    pub(crate) fn count_watch(&self, begins: bool) {
        if begins {
            self.shared.watches.fetch_add(1, Ordering::SeqCst);
        } else {
            self.shared.watches.fetch_sub(1, Ordering::SeqCst);
        }
        self.mark_arrived();
    }

    /// Returns the comparisons of messages made so far.
    #[cfg(feature = "protobuf")]
    pub(super) fn compared(&self) -> &Compared {
        &self.shared.compared
    }

    /// Creates and verifies the folder again, and the runtime folder above it, if they were removed.
    pub(crate) fn create_again(&self) -> Result<(), RuntimeDirError> {
        self.shared.runtime_dir.create()?;
        self.create()
    }

    fn create(&self) -> Result<(), RuntimeDirError> {
        create_folder(&self.path, false)
    }
}

/// Creates a folder, with its parents if it was chosen, and verifies it.
fn create_folder(path: &Path, is_chosen: bool) -> Result<(), RuntimeDirError> {
    match DirBuilder::new().mode(0o700).recursive(is_chosen).create(path) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            Err(RuntimeDirError::io("create the runtime folder", path, error))
        }
        _ => verify_folder(path, is_chosen),
    }
}

/// Verifies a folder. Returns false if it does not exist.
fn verify_existing(path: &Path, others_may_read: bool) -> Result<bool, RuntimeDirError> {
    match fs::symlink_metadata(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(false),
        _ => verify_folder(path, others_may_read).map(|()| true),
    }
}

/// Verifies that a folder is safe from other users. Doing so once is enough: other users cannot change a folder that is
/// ours and not writable for them, in a parent that is ours too, or sticky as folders for temporary files are.
fn verify_folder(path: &Path, others_may_read: bool) -> Result<(), RuntimeDirError> {
    let found =
        fs::symlink_metadata(path).map_err(|error| RuntimeDirError::io("examine the runtime folder", path, error))?;
    let path = path.to_owned();
    if !found.is_dir() {
        let found = if found.is_symlink() { "a symbolic link" } else { "a file" };
        return Err(RuntimeDirError::NotAFolder { path, found });
    }
    if found.uid() != own_user() {
        return Err(RuntimeDirError::ForeignOwner { path, owner: found.uid(), user: own_user() });
    }
    match too_open(found.mode(), others_may_read) {
        Some((who, may)) => Err(RuntimeDirError::OpenToOthers { path, mode: found.mode() & 0o7777, who, may }),
        None => Ok(()),
    }
}

fn too_open(mode: u32, others_may_read: bool) -> Option<(&'static str, &'static str)> {
    let permissions = [
        (0o002, "every user", "write to", true),
        (0o020, "the group", "write to", true),
        (0o005, "every user", "access", !others_may_read),
        (0o050, "the group", "access", !others_may_read),
    ];
    let mut refused = permissions.into_iter().filter(|&(bits, _, _, refused)| refused && mode & bits != 0);
    refused.next().map(|(_, who, may, _)| (who, may))
}

fn is_own_folder(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|found| found.is_dir() && found.uid() == own_user())
}

fn own_user() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// Returns the name if it stays inside its folder and differs from temporary names, which start with a full stop.
/// Shortened names of connections contain `~`.
fn plain<'n>(what: &'static str, name: &'n str) -> Result<&'n str, RuntimeDirError> {
    if is_plain(name) { Ok(name) } else { Err(RuntimeDirError::BadName { what, name: name.to_owned() }) }
}

pub(super) fn is_plain(name: &str) -> bool {
    let fits = |c: char| c.is_ascii_alphanumeric() || "_-.~".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(fits)
}
