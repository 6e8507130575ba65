use std::{
    ffi::OsString,
    fs, io,
    os::unix::{
        ffi::OsStrExt,
        fs::{DirBuilderExt, MetadataExt},
    },
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::{
    SOCKET_PATH_LIMIT,
    draft::{NAME_BYTES, sweep_drafts},
    error::PlaceError,
};

/// The endings of SCL's own files; no endpoint may have one, or binding it would replace such a file.
const RESERVED: [&str; 3] = [".lock", ".json", ".tcp"];

/// The folder below which every system has its own: made and verified, so that no other user can listen in.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct RuntimeDir {
    path: PathBuf,
}

impl RuntimeDir {
    /// Finds, makes and verifies the runtime folder.
    ///
    /// The first that fits: `$SCL_RUNTIME_DIR`; `scl` in `$XDG_RUNTIME_DIR` if that is a folder of this user; `scl-<uid>`
    /// in `$TMPDIR`, else in `/tmp`. Variables that are empty count as unset, as do `XDG_RUNTIME_DIR` and `TMPDIR` when
    /// they are not absolute. What is missing is made with mode 0700. The folder must be a folder and not a link, and
    /// belong to this user. Other users may not write to the one from `$SCL_RUNTIME_DIR`, and have no rights at all in
    /// the other two.
    ///
    /// `env` gives the value of a variable: `&|name| std::env::var_os(name)`.
    ///
    /// # Errors
    ///
    /// [`PlaceError`] when the folder cannot be made or is not safe. The next candidate is not tried then: components
    /// that fall back differently would never meet.
    pub fn locate(env: &dyn Fn(&str) -> Option<OsString>) -> Result<Self, PlaceError> {
        let variable = |name| env(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        let absolute = |name| variable(name).filter(|path| path.is_absolute());
        if let Some(path) = variable("SCL_RUNTIME_DIR") {
            return chosen(path);
        }
        let path = match absolute("XDG_RUNTIME_DIR").filter(|path| is_own_folder(path)) {
            Some(session) => session.join("scl"),
            None => absolute("TMPDIR").unwrap_or_else(|| "/tmp".into()).join(format!("scl-{}", own_user())),
        };
        make_folder(&path, false)?;
        verify_folder(&path, Rights::None)?;
        Ok(Self { path })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes and verifies the folder of one system, and removes half-made files that a killed program left there.
    ///
    /// # Errors
    ///
    /// [`PlaceError`] when the name cannot be that of a folder, or the folder cannot be made or is not safe.
    pub fn system(&self, name: &str) -> Result<SystemDir, PlaceError> {
        let path = self.path.join(plain("a system", name)?);
        make_folder(&path, false)?;
        verify_folder(&path, Rights::None)?;
        sweep_drafts(&path, SystemTime::now());
        Ok(SystemDir { path })
    }
}

/// The folder in which the components of one system meet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SystemDir {
    path: PathBuf,
}

impl SystemDir {
    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.path
    }

    /// The path of an endpoint's socket.
    ///
    /// # Errors
    ///
    /// [`PlaceError::PathTooLong`] over [`SOCKET_PATH_LIMIT`] bytes; [`PlaceError::BadName`] and
    /// [`PlaceError::ReservedName`] when the endpoint cannot be the name of a socket.
    pub fn path(&self, endpoint: &str) -> Result<PathBuf, PlaceError> {
        if let Some(ending) = RESERVED.into_iter().find(|ending| endpoint.ends_with(ending)) {
            return Err(PlaceError::ReservedName { endpoint: endpoint.to_owned(), ending });
        }
        let path = self.path.join(plain("an endpoint", endpoint)?);
        // The socket is bound under a temporary name, which may be the longer of the two.
        let name = endpoint.len().max(NAME_BYTES);
        let length = self.path.as_os_str().as_bytes().len() + 1 + name;
        if length > SOCKET_PATH_LIMIT {
            let system = self.path.file_name().map_or(0, |name| name.as_bytes().len());
            let room = SOCKET_PATH_LIMIT.saturating_sub(system + name + 2);
            return Err(PlaceError::PathTooLong { path, length, room });
        }
        Ok(path)
    }

    /// The path of one of a component's own files; `ending` starts with a full stop.
    pub(super) fn file_of(&self, component: &str, ending: &str) -> Result<PathBuf, PlaceError> {
        Ok(self.path.join(format!("{}{ending}", plain("a component", component)?)))
    }
}

/// What others may do in a folder.
#[derive(Clone, Copy)]
enum Rights {
    None,
    Read,
}

fn chosen(path: PathBuf) -> Result<RuntimeDir, PlaceError> {
    if !path.is_absolute() {
        return Err(PlaceError::RelativeFolder { variable: "SCL_RUNTIME_DIR", path });
    }
    // A slash at the end would make the check below follow a link; taking the path apart removes it.
    let path: PathBuf = path.components().collect();
    make_folder(&path, true)?;
    verify_folder(&path, Rights::Read)?;
    Ok(RuntimeDir { path })
}

fn make_folder(path: &Path, parents: bool) -> Result<(), PlaceError> {
    match fs::DirBuilder::new().mode(0o700).recursive(parents).create(path) {
        // What is there already is looked at next, whatever it is.
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            Err(PlaceError::io("make the runtime folder", path, error))
        }
        _ => Ok(()),
    }
}

/// Looking once is enough: in a folder of our own that others cannot write to, and whose parent is ours or sticky as
/// folders for temporary files are, nobody else can change what was seen.
fn verify_folder(path: &Path, others: Rights) -> Result<(), PlaceError> {
    let seen = fs::symlink_metadata(path).map_err(|error| PlaceError::io("look at the runtime folder", path, error))?;
    let path = path.to_owned();
    if !seen.is_dir() {
        let found = if seen.is_symlink() { "a symbolic link" } else { "a file" };
        return Err(PlaceError::NotAFolder { path, found });
    }
    if seen.uid() != own_user() {
        return Err(PlaceError::ForeignOwner { path, owner: seen.uid(), user: own_user() });
    }
    match too_open(seen.mode(), others) {
        Some((who, may)) => Err(PlaceError::OpenToOthers { path, mode: seen.mode() & 0o7777, who, may }),
        None => Ok(()),
    }
}

fn too_open(mode: u32, others: Rights) -> Option<(&'static str, &'static str)> {
    let looking = matches!(others, Rights::None);
    let rights = [
        (0o002, "every user", "write to", true),
        (0o020, "the group", "write to", true),
        (0o005, "every user", "look into", looking),
        (0o050, "the group", "look into", looking),
    ];
    rights.into_iter().find(|&(bits, _, _, refused)| refused && mode & bits != 0).map(|(_, who, may, _)| (who, may))
}

fn is_own_folder(path: &Path) -> bool {
    fs::metadata(path).is_ok_and(|seen| seen.is_dir() && seen.uid() == own_user())
}

fn own_user() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// A name that stays inside its folder, and out of the way of the temporary names, which start with a full stop.
fn plain<'n>(what: &'static str, name: &'n str) -> Result<&'n str, PlaceError> {
    let fits = |c: char| c.is_ascii_alphanumeric() || "_-.".contains(c);
    if name.is_empty() || name.starts_with('.') || !name.chars().all(fits) {
        return Err(PlaceError::BadName { what, name: name.to_owned() });
    }
    Ok(name)
}
