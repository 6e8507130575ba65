//! Processes that do not outlive the test that started them.

use std::ops::{Deref, DerefMut};
use std::process::{Child, Command, Output};

/// A process that is killed when it is dropped, also while a test panics.
pub(crate) struct ChildGuard(Option<Child>);

pub(crate) trait SpawnGuarded {
    /// Starts a program that ends with the test.
    fn spawn_guarded(&mut self) -> ChildGuard;
}

impl SpawnGuarded for Command {
    #[track_caller]
    fn spawn_guarded(&mut self) -> ChildGuard {
        #[expect(clippy::disallowed_methods, reason = "the one place")]
        ChildGuard(Some(self.spawn().unwrap()))
    }
}

impl ChildGuard {
    pub(crate) fn wait_with_output(mut self) -> Output {
        self.0.take().expect("is taken here only").wait_with_output().unwrap()
    }
}

impl Deref for ChildGuard {
    type Target = Child;

    fn deref(&self) -> &Child {
        self.0.as_ref().expect("is taken with the guard")
    }
}

impl DerefMut for ChildGuard {
    fn deref_mut(&mut self) -> &mut Child {
        self.0.as_mut().expect("is taken with the guard")
    }
}

impl Drop for ChildGuard {
    fn drop(&mut self) {
        if let Some(child) = &mut self.0 {
            // It may have ended.
            let _killed = child.kill();
            let _status = child.wait();
        }
    }
}
