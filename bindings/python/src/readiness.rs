//! A file descriptor for event loops.

use crate::native::Native;
use pyo3::prelude::*;
use scl::untyped;
use std::os::fd::AsRawFd;

/// A file descriptor that is readable while there is something to do for an event loop.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Readiness {
    pub(crate) readiness: Native<untyped::Readiness>,
}

#[pymethods]
impl Readiness {
    fn fileno(&self) -> i32 {
        self.readiness.as_raw_fd()
    }

    /// Acknowledges what made the descriptor readable. Call it before polling gates again.
    fn acknowledge(&self) {
        self.readiness.acknowledge();
        self.readiness.acknowledge_stop();
    }
}
