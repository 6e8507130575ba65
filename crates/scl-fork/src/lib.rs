//! Values that belong to the process that created them.
//!
//! A process that forks shares open files, sockets and memory with its child, and the child has a copy of every value.
//! A value that releases something shared must not do so in the child, because the parent still uses it. And whatever
//! the parent's threads had locked or half changed at the moment of the fork stays so in the child, which has none of
//! these threads.
//!
//! ```
//! use scl_fork::ProcessOwned;
//!
//! let lent = ProcessOwned::new(vec![1, 2, 3]);
//! assert_eq!(lent.len(), 3);
//! // Gives the memory back here. In a child forked meanwhile, nothing would happen.
//! drop(lent);
//! ```
#![deny(missing_docs)]

use forkguard::atfork::Guard;
use std::mem;
use std::ops::{Deref, DerefMut};

/// Remembers the process that created it. Copies remember the same one.
#[derive(Debug, Clone)]
pub struct ProcessMark(Mark);

#[derive(Debug, Clone)]
enum Mark {
    /// Counts forks without a system call: the C library does not cache the process id.
    Forks(Guard),
    /// The process id, if the C library could not register the fork handler.
    Process(u32),
}

impl ProcessMark {
    /// The mark of this process.
    pub fn new() -> Self {
        Self(Guard::try_new().map_or_else(|_| Mark::Process(std::process::id()), Mark::Forks))
    }

    /// Returns true in the process that created the mark, and false in a child forked from it. Cheap enough for every
    /// message.
    pub fn is_own(&self) -> bool {
        match &self.0 {
            // A guard reports a fork only once, so ask a copy.
            Mark::Forks(forks) => !forks.clone().detected_fork(),
            Mark::Process(process) => *process == std::process::id(),
        }
    }

    /// The mark of another process, as a forked child inherits it: for tests.
    #[doc(hidden)]
    pub fn inherited() -> Self {
        Self(Mark::Process(std::process::id().wrapping_add(1)))
    }
}

impl Default for ProcessMark {
    fn default() -> Self {
        Self::new()
    }
}

/// A value that is dropped only in the process that created it. A forked child leaks it instead.
#[derive(Debug)]
pub struct ProcessOwned<T> {
    /// `None` only while it is dropped.
    value: Option<T>,
    process: ProcessMark,
}

impl<T> ProcessOwned<T> {
    /// A value of this process.
    pub fn new(value: T) -> Self {
        Self { value: Some(value), process: ProcessMark::new() }
    }

    /// Returns true in the process that created it, and false in a child forked from it.
    pub fn is_own(&self) -> bool {
        self.process.is_own()
    }

    /// Returns the value, which from then on is dropped like any other.
    pub fn into_inner(mut self) -> T {
        self.value.take().unwrap_or_else(|| unreachable!("{GONE}"))
    }

    /// Makes it a value of another process, as a forked child inherits it: for tests.
    #[doc(hidden)]
    pub fn inherit(&mut self) {
        self.process = ProcessMark::inherited();
    }
}

const GONE: &str = "the value is taken only when it is dropped";

impl<T> Deref for ProcessOwned<T> {
    type Target = T;

    fn deref(&self) -> &T {
        self.value.as_ref().unwrap_or_else(|| unreachable!("{GONE}"))
    }
}

impl<T> DerefMut for ProcessOwned<T> {
    fn deref_mut(&mut self) -> &mut T {
        self.value.as_mut().unwrap_or_else(|| unreachable!("{GONE}"))
    }
}

impl<T> Drop for ProcessOwned<T> {
    fn drop(&mut self) {
        if !self.process.is_own() {
            mem::forget(self.value.take());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;

    #[test]
    fn a_mark_is_that_of_its_process() {
        assert!(ProcessMark::new().is_own());
        assert!(ProcessMark::new().clone().is_own());
        assert!(!ProcessMark::inherited().is_own());
        assert!(!ProcessMark::inherited().clone().is_own());
    }

    #[test]
    fn a_value_is_dropped_in_its_process_only() {
        let shared = Arc::new(());
        let owned = ProcessOwned::new(Arc::clone(&shared));
        let mut inherited = ProcessOwned::new(Arc::clone(&shared));
        inherited.inherit();
        drop((owned, inherited));
        assert_eq!(Arc::strong_count(&shared), 2, "the inherited one is kept");
    }

    #[test]
    fn a_value_that_is_taken_out_is_dropped_by_who_took_it() {
        let shared = Arc::new(());
        let taken = ProcessOwned::new(Arc::clone(&shared)).into_inner();
        assert_eq!(Arc::strong_count(&shared), 2);
        drop(taken);
        assert_eq!(Arc::strong_count(&shared), 1);
    }
}
