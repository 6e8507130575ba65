//! How long the names of sockets may be. Where sockets live is not known here; the caller says it.

use crate::resolve::CONTRACT_LENGTH;

/// The paths of sockets, as far as the names of components and gates are limited by them.
///
/// All programs of a system must be built with the same values, because long names of connections are shortened to fit.
/// The default has no limit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SocketPaths {
    /// The folder of all systems where its path is longest, without a slash at its end. Each system has a folder of its
    /// own in it.
    pub longest_root: String,
    /// The longest path of a socket that the operating system accepts, in bytes.
    pub limit: usize,
}

impl Default for SocketPaths {
    fn default() -> Self {
        Self { longest_root: String::new(), limit: usize::MAX }
    }
}

impl SocketPaths {
    /// The folder of a system, with a slash at its end.
    pub(crate) fn folder(&self, system: &str) -> String {
        format!("{}/{system}/", self.longest_root)
    }

    /// How many bytes of a path are left for the two gates of a connection.
    pub(crate) fn connection_room(&self, system: &str) -> usize {
        self.limit.saturating_sub(self.folder(system).len() + 1 + CONTRACT_LENGTH)
    }
}

impl SocketPaths {
    /// Paths for the examples in the explanations of rules, and for tests. Nothing is built with them.
    pub(crate) fn example() -> Self {
        Self { longest_root: "/run/user/4294967295/scl".to_owned(), limit: 107 }
    }
}
