//! Telling a process from its forked children, which inherit all values but must not act on them.

use forkguard::atfork::Guard;

/// Remembers the process that created it.
///
/// A process that forks shares open files with its child, and the child has copies of all guards. Whatever releases or
/// removes something shared checks [`is_own`](Self::is_own) first.
#[derive(Debug, Clone)]
pub(crate) struct ProcessMark {
    pid: u32,
    /// Counts forks without a system call, unless the C library refused to.
    forks: Option<Guard>,
}

impl ProcessMark {
    pub(crate) fn new() -> Self {
        Self { pid: std::process::id(), forks: Guard::try_new().ok() }
    }

    /// Returns true in the process that created the mark, and false in a child forked from it.
    ///
    /// Cheap enough for every message: the C library does not cache the process id, so `getpid` would be a system call.
    pub(crate) fn is_own(&self) -> bool {
        match &self.forks {
            // The guard reports a fork once, so it is a copy that is asked.
            Some(forks) => !forks.clone().detected_fork(),
            None => self.pid == std::process::id(),
        }
    }

    /// The mark of another process, as a forked child inherits it.
    #[cfg(test)]
    pub(crate) fn inherited() -> Self {
        Self { pid: std::process::id().wrapping_add(1), forks: None }
    }
}
