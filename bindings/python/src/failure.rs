//! Errors on their way to Python: the class of `scl._errors`, and the text.

use crate::process::{Inside, thread_exit};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyType;
use scl::host::{self, ErrorKind, text_with_causes};
use scl::{BlockingError, OpenError};
use std::error::Error;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// An exception that is not made yet, so that it can be passed through code that has released the interpreter.
#[derive(Debug)]
pub(crate) struct Failure {
    class: &'static str,
    text: String,
}

impl Failure {
    pub(crate) fn new(class: &'static str, text: impl Into<String>) -> Self {
        Self { class, text: text.into() }
    }

    pub(crate) fn is(&self, class: &str) -> bool {
        self.class == class
    }

    /// The failure for an error of `scl`.
    pub(crate) fn of(error: &(dyn Error + 'static)) -> Self {
        let class = match ErrorKind::of(error) {
            ErrorKind::Blocking(BlockingError::Stopped) => "Stopped",
            ErrorKind::Blocking(BlockingError::Forked) => "Forked",
            // A stop request takes precedence: it may be why the program closed the component during this call.
            ErrorKind::Blocking(_) if host::gates_stopped() => "Stopped",
            ErrorKind::Blocking(_) => "Closed",
            ErrorKind::Open(OpenError::Plan { .. }) => "PlanError",
            ErrorKind::Open(OpenError::UnknownComponent(_)) => "UnknownComponent",
            ErrorKind::Open(_) => "OpenError",
            ErrorKind::NotReady => "NotReady",
            ErrorKind::NotFlushed => "NotFlushed",
            ErrorKind::Encode => "EncodeError",
            ErrorKind::TooLong => "TooLong",
            ErrorKind::Full | ErrorKind::SendTimeout => "Full",
            ErrorKind::Timeout => "Timeout",
            ErrorKind::Decode => "DecodeError",
            ErrorKind::PeerLost => "PeerLost",
            ErrorKind::Refused => "Refused",
            ErrorKind::RequesterGone => "RequesterGone",
            _ => "Error",
        };
        Self::new(class, text_with_causes(error))
    }

    fn raised(&self, py: Python<'_>) -> PyResult<PyErr> {
        if self.is("Stopped") {
            // Its class depends on where it is raised: in the main thread, in another thread or in an asyncio task.
            let stopped = py.import("scl._stopping")?.getattr("stopped")?.call1((&self.text,))?;
            return Ok(PyErr::from_value(stopped));
        }
        let class = py.import("scl._errors")?.getattr(self.class)?.cast_into::<PyType>()?;
        Ok(PyErr::from_type(class, self.text.clone()))
    }
}

/// Turns a panic into an exception, because no panic may cross the border.
pub(crate) fn no_panic<T>(call: impl FnOnce() -> Result<T, Failure>) -> Result<T, Failure> {
    catch_unwind(AssertUnwindSafe(call)).unwrap_or_else(|panic| {
        let text = panic.downcast_ref::<String>().map(String::as_str);
        let text = text.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("no message");
        Err(Failure::new("InternalError", format!("internal error of SCL, please report it: {text}")))
    })
}

impl From<Failure> for PyErr {
    fn from(failure: Failure) -> Self {
        Python::attach(|py| {
            // Another thread is ending the interpreter and closing the components; this failure is only a consequence.
            let Some(_inside) = Inside::enter() else { return thread_exit() };
            failure.raised(py).unwrap_or_else(|_| {
                // Happens only if the Python part of the package is missing.
                PyRuntimeError::new_err(failure.text)
            })
        })
    }
}

impl<E: Error + 'static> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::of(&error)
    }
}
