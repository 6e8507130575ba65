use std::{
    fmt, io,
    path::{Path, PathBuf},
};

use rustix::io::Errno;

use super::SOCKET_PATH_LIMIT;

/// Why a component cannot take its place among the others.
///
/// The first line of the text says what is wrong, the line after it what to do.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PlaceError {
    /// A folder was named by a path that means another place in every working folder.
    #[error(
        "`{variable}` is `{}`, which is not an absolute path\n\
         help: write the whole path, so that all components meet in the same folder wherever they are started",
        path.display()
    )]
    RelativeFolder {
        /// The variable of the environment.
        variable: &'static str,
        /// Its value.
        path: PathBuf,
    },

    /// Something else has the name of a folder.
    #[error(
        "the runtime folder `{}` is {found}, not a folder\n\
         help: remove it, or choose another folder with `SCL_RUNTIME_DIR`",
        path.display()
    )]
    NotAFolder {
        /// The path of the folder.
        path: PathBuf,
        /// What is there: `a symbolic link`, `a file`.
        found: &'static str,
    },

    /// A folder belongs to another user, who could read and replace everything in it.
    #[error(
        "the runtime folder `{}` belongs to user {owner}, but this program runs as user {user}\n\
         help: run all components of a system as one user, or choose a folder of your own with `SCL_RUNTIME_DIR`",
        path.display()
    )]
    ForeignOwner {
        /// The path of the folder.
        path: PathBuf,
        /// The number of the user that owns it.
        owner: u32,
        /// The number of the user that this program runs as.
        user: u32,
    },

    /// Other users may do more in a folder than is safe.
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
        /// Who has too many rights: `the group`, `every user`.
        who: &'static str,
        /// What they may do: `write to`, `look into`.
        may: &'static str,
    },

    /// A name that cannot be a file in the runtime folder.
    #[error(
        "`{name}` cannot be the name of {what}\n\
         help: take letters, digits and underscores; the name becomes a file in the runtime folder"
    )]
    BadName {
        /// What is named: `a system`, `a component`, `an endpoint`.
        what: &'static str,
        /// The name.
        name: String,
    },

    /// An endpoint that would replace a file of SCL's own.
    #[error(
        "the endpoint `{endpoint}` ends in `{ending}`, which marks SCL's own files in the runtime folder\n\
         help: give the gate another name"
    )]
    ReservedName {
        /// The endpoint.
        endpoint: String,
        /// Its ending.
        ending: &'static str,
    },

    /// A socket's path does not fit a socket address.
    #[error(
        "the path of the socket `{}` takes {length} bytes, but the operating system allows {SOCKET_PATH_LIMIT}\n\
         help: {}",
        path.display(),
        shorten(*room)
    )]
    PathTooLong {
        /// The path.
        path: PathBuf,
        /// The bytes that it takes, or that its name while binding takes if that is longer.
        length: usize,
        /// The longest runtime folder that would fit, in bytes.
        room: usize,
    },

    /// Another program plays this component already.
    #[error(
        "the component `{component}` is already played by {holder}\n\
         help: stop that one first, or start this program in another system with `SCL_SYSTEM`"
    )]
    AlreadyRunning {
        /// The component.
        component: String,
        /// Who plays it.
        holder: Holder,
        /// The lock that both want.
        lock: PathBuf,
    },

    /// The operating system refused something; the source says what.
    #[error("cannot {action} `{}`\nhelp: {}", path.display(), way_out(source))]
    Io {
        /// What was tried.
        action: &'static str,
        /// On which path.
        path: PathBuf,
        /// What the operating system answered.
        source: io::Error,
    },
}

/// Who holds the lock of a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Holder {
    /// This program itself: it has opened the component twice.
    ThisProcess,
    /// The process with this number.
    Process(u32),
    /// A process that has not written its number, or not a readable one.
    Unknown,
}

impl fmt::Display for Holder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ThisProcess => write!(f, "this same process, which has opened it before"),
            Self::Process(pid) => write!(f, "process {pid}"),
            Self::Unknown => write!(f, "another process"),
        }
    }
}

impl PlaceError {
    pub(super) fn io(action: &'static str, path: &Path, source: io::Error) -> Self {
        Self::Io { action, path: path.to_owned(), source }
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

fn way_out(source: &io::Error) -> &'static str {
    let no_descriptors = [Errno::MFILE, Errno::NFILE].map(Errno::raw_os_error);
    match source.kind() {
        _ if source.raw_os_error().is_some_and(|error| no_descriptors.contains(&error)) => {
            "no file descriptor is left: raise the limit with `ulimit -n`, or close what the program keeps open"
        }
        io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded => {
            "free some space there, or choose a folder on another disk with `SCL_RUNTIME_DIR`"
        }
        io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
            "choose a folder that this user may write to with `SCL_RUNTIME_DIR`"
        }
        io::ErrorKind::NotFound => {
            "its folder is missing or was removed; start again to have it made anew, \
             or choose another one with `SCL_RUNTIME_DIR`"
        }
        _ => "look at what is there, or choose another folder with `SCL_RUNTIME_DIR`",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_refusal_of_the_operating_system_has_its_way_out() {
        let cases = [
            (Errno::NOSPC, "free some space there"),
            (Errno::DQUOT, "free some space there"),
            (Errno::ROFS, "choose a folder that this user may write to"),
            (Errno::ACCESS, "choose a folder that this user may write to"),
            (Errno::NOENT, "its folder is missing or was removed"),
            (Errno::MFILE, "no file descriptor is left"),
            (Errno::NFILE, "no file descriptor is left"),
            (Errno::IO, "look at what is there"),
        ];
        for (errno, expected) in cases {
            let error = PlaceError::io("bind the socket", Path::new("/run/scl/a.b"), errno.into());
            let text = error.to_string();
            assert!(text.starts_with(&format!("cannot bind the socket `/run/scl/a.b`\nhelp: {expected}")), "{text}");
            assert_eq!(
                std::error::Error::source(&error).map(ToString::to_string),
                Some(io::Error::from(errno).to_string())
            );
        }
    }
}
