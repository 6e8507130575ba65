//! The runtime folder: where the components of a system find each other.
//!
//! ```text
//! <runtime folder>/<system>/                     mode 0700
//!     <component>.lock                           locked by the process that runs the component
//!     <component>.json                           what that process offers, see Announcement
//!     <pub>.<gate>--<sub>.<gate>.<contract>      the socket of a connection
//!     <component>.<gate>.<contract>              the socket of a `rep` or `pull` gate
//!     <component>.<gate>.tap                     the socket where tools observe a gate
//!     <endpoint>.tcp                             `127.0.0.1:<port>`, in place of a socket
//!     <component>.stats                          what it has done lately, see ComponentStats
//!     <component>.values                         the values of its parameters, see scl::parameters
//!     <component>.set                            the socket where live parameters are set
//!     <hash>.schema                              the protobuf messages that a program was built with
//!     run.<pid>.control, run.<pid>.notify        the sockets of an `scl run`
//!     <pid>.recorder                             the socket of a recorder that waits for its trigger
//! ```
//!
//! The runtime folder is the first of these that applies: `$SCL_RUNTIME_DIR`; `$XDG_RUNTIME_DIR/scl`; `scl-<uid>` in
//! the folder for temporary files. All folders are created with mode 0700 and verified, so no other user can read or
//! replace anything in them.
//!
//! Every file appears under its name complete and in one step: it is written or bound under a temporary name and then
//! renamed. It is removed when its owner closes it, unless another process has replaced it. Files left behind by a
//! killed process are replaced or removed when its component starts again. If the folder is removed while programs run,
//! they create it again.
//!
//! The lock file stays; what counts is whether it is locked. The operating system releases the lock when the process
//! ends, also when it is killed, and forked children do not inherit it.
//!
//! # Example
//!
//! Reading what a running component offers:
//!
//! ```
//! use scl::runtime_dir::{Announcement, RuntimeDir};
//!
//! # let folder = tempfile::tempdir()?;
//! # let env = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
//! // Outside of tests: `let env = |name: &str| std::env::var_os(name);`
//! let dir = RuntimeDir::locate(&env)?.system("rover")?;
//! if let Some(sensor) = Announcement::read(&dir, "sensor") {
//!     println!("process {} with {} endpoints", sensor.pid, sensor.endpoints.len());
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod announcement;
mod arrival_watch;
mod bind;
#[cfg(feature = "protobuf")]
mod compared;
mod error;
mod event_count;
mod find;
mod folder;
mod folder_watch;
mod foreign_text;
mod held_locks;
mod inotify;
mod lock;
mod look;
#[cfg(feature = "protobuf")]
mod messages;
mod owned_path;
mod peer_check;
mod schema;
mod small_file;
mod stats;
mod temp_entry;
mod values;

pub use announcement::{AnnouncedEndpoint, Announcement};
pub use arrival_watch::ArrivalWatch;
#[cfg(feature = "zeromq")]
pub(crate) use bind::{bind_ipc, bind_tcp};
pub use error::{ComponentProcess, RuntimeDirError};
#[cfg(feature = "zeromq")]
pub(crate) use event_count::Seen;
#[cfg(feature = "zeromq")]
pub(crate) use find::{Address, find};
pub use folder::{RuntimeDir, SystemDir};
pub(crate) use folder_watch::{FolderWatch, QUIET};
pub(crate) use inotify::Inotify;
pub(crate) use lock::ComponentLock;
pub use look::ComponentState;
pub(crate) use owned_path::OwnedPath;
pub(crate) use peer_check::{check_peer, explain_missing};
pub(crate) use schema::publish_schema;
pub(crate) use stats::StatsFile;
pub use stats::{ComponentStats, ConnectionFigures, GateFigures};
pub(crate) use values::{ValuesFile, read_values, remove_values};

/// The longest path of a Unix socket in bytes, without its terminating zero.
const SOCKET_PATH_LIMIT: usize = 107;

/// What the tests and fuzzers of this workspace use besides the public items.
#[doc(hidden)]
pub mod internals {
    pub use super::bind::{BoundIpc, BoundTcp, bind_ipc, bind_tcp};
    pub use super::find::{Address, find};
    pub use super::lock::ComponentLock;
    pub use super::owned_path::OwnedPath;
    pub use super::peer_check::{check_peer, explain_missing};
}
