//! Errors on their way to Python: the class of `scl._errors`, and the text.

use crate::process::{Inside, thread_exit};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::PyType;
use scl::host::{self, text_with_causes};
use scl::{
    BlockingError, CallError, NotFlushed, NotReady, RecvError, RecvTimeoutError, ReplyError, SendError,
    SendTimeoutError, TrySendError,
};
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

    /// The failure of a call that may fail in several ways.
    pub(crate) fn of_box(error: &(dyn std::error::Error + 'static)) -> Self {
        match error.downcast_ref::<BlockingError>() {
            Some(error) => (*error).into(),
            None if error.is::<NotFlushed>() => Self::of("NotFlushed", error),
            None if error.is::<NotReady>() => Self::of("NotReady", error),
            None => Self::of("Error", error),
        }
    }

    fn of(class: &'static str, error: &dyn std::error::Error) -> Self {
        Self::new(class, text_with_causes(error))
    }

    fn raised(&self, py: Python<'_>) -> PyResult<PyErr> {
        if self.is("Stopped") {
            // Its class depends on who is to receive it.
            let stopped = py.import("scl._stopping")?.getattr("stopped")?.call1((&self.text,))?;
            return Ok(PyErr::from_value(stopped));
        }
        let class = py.import("scl._errors")?.getattr(self.class)?.cast_into::<PyType>()?;
        Ok(PyErr::from_type(class, self.text.clone()))
    }
}

/// Turns a panic into an exception: none may cross the border.
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
            // The components are being closed, so that the failure says nothing to the program.
            let Some(_inside) = Inside::enter() else { return thread_exit() };
            failure.raised(py).unwrap_or_else(|_| {
                // Only without the Python part of the package.
                PyRuntimeError::new_err(failure.text)
            })
        })
    }
}

fn class_of(error: BlockingError) -> &'static str {
    match error {
        BlockingError::Stopped => "Stopped",
        BlockingError::Forked => "Forked",
        // The component may have been closed after the request and during the call.
        _ if host::gates_stopped() => "Stopped",
        _ => "Closed",
    }
}

impl From<scl::OpenError> for Failure {
    fn from(error: scl::OpenError) -> Self {
        match error {
            scl::OpenError::Plan { .. } => Self::of("PlanError", &error),
            _ => Self::of("OpenError", &error),
        }
    }
}

/// The classes of errors that are not the end of the component.
macro_rules! classes {
    ($($error:ident { $($variant:ident => $class:literal),+ })+) => { $(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                let class = match &error {
                    $($error::$variant { .. } => $class,)+
                    $error::Blocking { source, .. } => class_of(*source),
                    _ => "Error",
                };
                Self::of(class, &error)
            }
        }
    )+ };
}

classes! {
    SendError { Encode => "EncodeError", TooLong => "TooLong" }
    RecvError { Decode => "DecodeError" }
    CallError {
        Encode => "EncodeError",
        TooLong => "TooLong",
        Timeout => "Timeout",
        PeerLost => "PeerLost",
        Refused => "Refused",
        Decode => "DecodeError"
    }
    ReplyError { Encode => "EncodeError", TooLong => "TooLong", RequesterGone => "RequesterGone" }
}

/// The class of an error that may also be that of a call without a time limit.
macro_rules! classes_of_timed {
    ($($error:ident { $variant:ident => $class:literal, $inner:ident })+) => { $(
        impl From<$error> for Failure {
            fn from(error: $error) -> Self {
                match error {
                    $error::$inner(error) => error.into(),
                    $error::$variant { .. } => Self::of($class, &error),
                    _ => Self::of("Error", &error),
                }
            }
        }
    )+ };
}

classes_of_timed! {
    TrySendError { Full => "Full", Send }
    SendTimeoutError { Timeout => "Full", Send }
    RecvTimeoutError { Timeout => "Timeout", Recv }
}

impl From<NotReady> for Failure {
    fn from(error: NotReady) -> Self {
        Self::of("NotReady", &error)
    }
}

impl From<BlockingError> for Failure {
    fn from(error: BlockingError) -> Self {
        Self::of(class_of(error), &error)
    }
}
