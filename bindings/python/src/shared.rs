//! What a component's gates share with it: its name, and whether they may still be used.

use crate::failure::Failure;
use crate::native::Native;
use scl::untyped::{Closer, Component, Driver};
use scl::{BlockingError, host};
use scl_fork::ProcessMark;
use std::sync::atomic::{AtomicBool, Ordering};

/// The state of a component, as seen by its calls.
pub(crate) struct Shared {
    pub(crate) component: String,
    pub(crate) system: String,
    process: ProcessMark,
    closed: AtomicBool,
    closer: Closer,
    pub(crate) driver: Driver,
}

impl Shared {
    pub(crate) fn new(opened: &Component, component: &str, system: &str) -> Self {
        let (component, system) = (component.to_owned(), system.to_owned());
        let (closer, driver) = (opened.closer(), opened.driver());
        Self { component, system, process: ProcessMark::new(), closed: AtomicBool::new(false), closer, driver }
    }

    /// Keeps a value of the component for a Python object.
    pub(crate) fn keep<T: Send>(&self, value: T) -> Native<T> {
        Native::new(value, self.process.clone())
    }

    /// Fails if calls may no longer be made, or continue to wait. A component that a forked child has inherited is
    /// detected first: its locks may be held by threads that exist in the parent only.
    ///
    /// A stop request takes precedence over the closing of the component, which often follows it: `Closed` is an
    /// `Exception`, and a task or thread that handles exceptions would continue.
    pub(crate) fn check(&self) -> Result<(), Failure> {
        if !self.is_inherited() && host::gates_stopped() {
            return Err(Failure::new("Stopped", "stop requested"));
        }
        self.check_open()
    }

    /// Returns the failure of a call whose gate is gone.
    pub(crate) fn ended(&self) -> Failure {
        self.check().err().unwrap_or_else(|| self.closed())
    }

    /// Like [`check`](Self::check), but for calls that also work after a stop request.
    pub(crate) fn check_open(&self) -> Result<(), Failure> {
        if self.is_inherited() {
            return Err(BlockingError::Forked.into());
        }
        if self.closed.load(Ordering::Acquire) {
            return Err(self.closed());
        }
        Ok(())
    }

    fn closed(&self) -> Failure {
        Failure::new("Closed", format!("component `{}` is closed", self.component))
    }

    pub(crate) fn is_inherited(&self) -> bool {
        !self.process.is_own()
    }

    pub(crate) fn is_closed(&self) -> bool {
        self.closed.load(Ordering::Acquire)
    }

    /// Ends all calls. Returns true if the component was closed before.
    pub(crate) fn close(&self) -> bool {
        let before = self.closed.swap(true, Ordering::AcqRel);
        self.closer.end_calls();
        before
    }
}
