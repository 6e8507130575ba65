//! Errors of the runtime folder.

use super::SOCKET_PATH_LIMIT;
use rustix::io::Errno;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// The runtime folder cannot be used.
///
/// The first line of the text says what is wrong, the second what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RuntimeDirError {
    /// A variable names a folder by a relative path, which would mean a different folder in every working folder.
    #[error(
        "`{variable}` is `{}`, which is not an absolute path\n\
         help: use an absolute path, so that all components use the same folder wherever they are started",
        path.display()
    )]
    RelativeFolder {
        /// The environment variable.
        variable: &'static str,
        /// Its value.
        path: PathBuf,
    },

    /// The path of a folder leads to a symbolic link or a file.
    #[error(
        "the runtime folder `{}` is {found}, not a folder\n\
         help: remove it, or choose another folder with `SCL_RUNTIME_DIR`",
        path.display()
    )]
    NotAFolder {
        /// The path of the folder.
        path: PathBuf,
        /// Kind of the existing file: `a symbolic link`, `a file`.
        found: &'static str,
    },

    /// A folder belongs to another user, who could read and replace everything in it.
    #[error(
        "the runtime folder `{}` belongs to user {owner}, but this program runs as user {user}\n\
         help: run all components of a system as the same user, or choose another folder with `SCL_RUNTIME_DIR`",
        path.display()
    )]
    ForeignOwner {
        /// The path of the folder.
        path: PathBuf,
        /// The id of the user that owns it.
        owner: u32,
        /// The id of the user that runs this program.
        user: u32,
    },

    /// A folder gives other users more permissions than is safe.
    #[error(
        "{who} may {may} the runtime folder `{}` (mode {mode:04o})\n\
         help: run `chmod 700 '{}'`, or choose another folder with `SCL_RUNTIME_DIR`",
        path.display(),
        path.display()
    )]
    OpenToOthers {
        /// The path of the folder.
        path: PathBuf,
        /// Its permissions.
        mode: u32,
        /// Who has too many permissions: `the group`, `every user`.
        who: &'static str,
        /// What the permissions allow: `write to`, `access`.
        may: &'static str,
    },

    /// A name cannot be the name of a file in the runtime folder.
    #[error(
        "`{name}` cannot be the name of {what}\n\
         help: use letters, digits and underscores; the name becomes a file in the runtime folder"
    )]
    BadName {
        /// What is named: `a system`, `a component`, `an endpoint`, `a schema`.
        what: &'static str,
        /// The name.
        name: String,
    },

    /// The socket of an endpoint would replace one of SCL's own files.
    #[error(
        "the endpoint `{endpoint}` ends in `{ending}`, which is reserved for SCL's own files in the runtime folder\n\
         help: rename the gate"
    )]
    ReservedName {
        /// The endpoint.
        endpoint: String,
        /// The reserved ending.
        ending: &'static str,
    },

    /// The path of a socket is longer than a socket address can be.
    #[error(
        "the path of the socket `{}` takes {length} bytes, but the operating system allows {SOCKET_PATH_LIMIT}\n\
         help: {}",
        path.display(),
        shorten(*room)
    )]
    PathTooLong {
        /// The path.
        path: PathBuf,
        /// Its length in bytes, or the length of the temporary path under which it is bound, if that is longer.
        length: usize,
        /// Length of the longest runtime folder that would fit, in bytes.
        room: usize,
    },

    /// The component is already running.
    #[error("component `{component}` is already {}\nhelp: {}", running(*holder), stop(*holder))]
    AlreadyRunning {
        /// The component.
        component: String,
        /// The process that runs it.
        holder: ComponentProcess,
        /// The lock file.
        lock: PathBuf,
    },

    /// The operating system refused an operation; the source says why.
    #[error("cannot {action} `{}`\nhelp: {}", path.display(), advice(source))]
    Io {
        /// The operation.
        action: &'static str,
        /// The path.
        path: PathBuf,
        /// The error of the operating system.
        source: io::Error,
    },
}

/// The process that runs a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ComponentProcess {
    /// This process.
    ThisProcess,
    /// The process with this id.
    Process(u32),
    /// A process that is not visible from here, for example in another container.
    Unknown,
}

impl fmt::Display for ComponentProcess {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ThisProcess => write!(f, "this process"),
            Self::Process(pid) => write!(f, "process {pid}"),
            Self::Unknown => write!(f, "a process of another container"),
        }
    }
}

impl RuntimeDirError {
    pub(crate) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source }
    }
}

/// Describes how a component is running, for texts such as ``component `imu` is running as process 20739``.
pub(super) fn running(holder: ComponentProcess) -> String {
    match holder {
        ComponentProcess::ThisProcess => "running in this process".to_owned(),
        holder => format!("running as {holder}"),
    }
}

fn stop(holder: ComponentProcess) -> &'static str {
    match holder {
        ComponentProcess::ThisProcess => "close or drop it before opening it again",
        _ => "stop that process first, or run this program in another system with `SCL_SYSTEM`",
    }
}

fn shorten(room: usize) -> String {
    match room {
        0..8 => "shorten `SCL_SYSTEM`, or the names of the components and gates; no folder is short enough".to_owned(),
        _ => format!(
            "set `SCL_RUNTIME_DIR` to a folder of at most {room} bytes, such as `/tmp/scl`, \
             or shorten the names of the components and gates"
        ),
    }
}

fn advice(source: &io::Error) -> &'static str {
    let no_descriptors = [Errno::MFILE, Errno::NFILE].map(Errno::raw_os_error);
    match source.kind() {
        _ if source.raw_os_error().is_some_and(|error| no_descriptors.contains(&error)) => {
            "the process is out of file descriptors: raise the limit with `ulimit -n`, or keep fewer files open"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space there, or choose a folder on another disk with `SCL_RUNTIME_DIR`"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "set `SCL_RUNTIME_DIR` to a folder that this user may write to"
        }
        io::ErrorKind::NotFound => {
            "its folder does not exist or was removed; start the program again to create it, \
             or choose another one with `SCL_RUNTIME_DIR`"
        }
        _ => "check what is there, or choose another folder with `SCL_RUNTIME_DIR`",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_error_of_the_operating_system_has_its_advice() {
        let cases = [
            (Errno::NOSPC, "free some space there"),
            (Errno::DQUOT, "free some space there"),
            (Errno::ROFS, "set `SCL_RUNTIME_DIR` to a folder that this user may write to"),
            (Errno::ACCESS, "set `SCL_RUNTIME_DIR` to a folder that this user may write to"),
            (Errno::NOENT, "its folder does not exist or was removed"),
            (Errno::MFILE, "the process is out of file descriptors"),
            (Errno::NFILE, "the process is out of file descriptors"),
            (Errno::IO, "check what is there"),
        ];
        for (errno, expected) in cases {
            let error = RuntimeDirError::io("bind the socket", Path::new("/run/scl/a.b"), errno.into());
            let text = error.to_string();
            assert!(text.starts_with(&format!("cannot bind the socket `/run/scl/a.b`\nhelp: {expected}")), "{text}");
            // The source's text belongs to the chain of sources only.
            let source = std::error::Error::source(&error).map(ToString::to_string).unwrap();
            assert_eq!(source, io::Error::from(errno).to_string());
            assert!(!text.contains(&source));
        }
    }

    #[test]
    fn each_holder_is_named_with_the_way_out() {
        let cases = [
            (
                ComponentProcess::Process(42),
                "running as process 42\nhelp: stop that process first, or run this program in",
            ),
            (ComponentProcess::ThisProcess, "running in this process\nhelp: close or drop it before opening it again"),
            (ComponentProcess::Unknown, "running as a process of another container\nhelp: stop that process first"),
        ];
        for (holder, expected) in cases {
            let (component, lock) = ("imu".to_owned(), PathBuf::from("/run/scl/rover/imu.lock"));
            let text = RuntimeDirError::AlreadyRunning { component, holder, lock }.to_string();
            assert!(text.starts_with(&format!("component `imu` is already {expected}")), "{text}");
        }
    }
}
