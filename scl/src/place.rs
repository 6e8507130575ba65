//! Where gates meet: the folders, sockets and small files through which the components of a system find each other.
//!
//! ```text
//! <runtime folder>/<system>/                     mode 0700
//!     <component>.lock                           who plays the component, held while it runs
//!     <component>.json                           what it offers, for tools and for error texts
//!     <pub>.<gate>--<sub>.<gate>.<contract>      the socket of a connection
//!     <endpoint>.tcp                             `127.0.0.1:<port>`, where a socket file is no use
//! ```
//!
//! Everything appears under its name in one step, complete (written or bound under a temporary name, then renamed), and
//! goes away with the value that made it, unless somebody else has taken its place by then. What a killed program leaves
//! behind is replaced, or removed by [`ComponentLock::clear_leftovers`], at the next start.
//!
//! All calls are synchronous and short; they touch local files only.
//!
//! # Example
//!
//! ```
//! use scl::place::{Address, ComponentLock, RuntimeDir, bind_ipc, find};
//!
//! # let folder = tempfile::tempdir()?;
//! # let env = |name: &str| (name == "SCL_RUNTIME_DIR").then(|| folder.path().into());
//! // Outside of tests: `let env = |name: &str| std::env::var_os(name);`
//! let dir = RuntimeDir::locate(&env)?.system("rover")?;
//! let lock = ComponentLock::take(&dir, "controller")?;
//! lock.clear_leftovers()?;
//! let bound = bind_ipc(&dir, "controller.commands.1a2b3c4d")?;
//! assert!(matches!(find(&dir, "controller.commands.1a2b3c4d"), Some(Address::Ipc(_))));
//! drop((bound, lock));
//! assert_eq!(find(&dir, "controller.commands.1a2b3c4d"), None);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod announcement;
mod bind;
mod claim;
mod draft;
mod error;
mod find;
mod folder;
mod holder;
mod lock;
mod small_file;

pub use announcement::{AnnouncedEndpoint, Announcement};
pub use bind::{BoundIpc, BoundTcp, bind_ipc, bind_tcp};
pub use claim::Claim;
pub use error::{Holder, PlaceError};
pub use find::{Address, Announced, find, other_contracts};
pub use folder::{RuntimeDir, SystemDir};
pub use lock::ComponentLock;

/// The longest path of a Unix socket in bytes, without its final zero.
pub const SOCKET_PATH_LIMIT: usize = 107;
