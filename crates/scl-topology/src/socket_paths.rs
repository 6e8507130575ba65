//! How long the names of sockets may be. The caller supplies the folder that sockets live in.

use crate::resolve::CONTRACT_LENGTH;

/// The limits that the paths of sockets set for the names of components and gates.
///
/// All programs of a system must be built with the same values, because long names of connections are shortened to fit.
/// The default has no limit.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SocketPaths {
    /// The longest path that the folder of all systems can have, without a slash at its end. Each system has its own
    /// folder in it.
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
