//! `scl._native`: components and gates for the Python package `scl`.
//!
//! Messages cross the border as bytes; the package encodes and decodes them. All promises of a gate are kept by the
//! crate `scl`. This thin layer on it decides which calls release the interpreter, when a wait checks for signals, and
//! which exception an error becomes.

mod claimed;
mod component;
mod failure;
mod gate;
mod limit;
mod logging;
mod native;
mod parameter;
mod pending_call;
mod pending_count;
mod plain;
mod plan;
mod process;
mod readiness;
mod request;
mod shared;
mod stats;
mod stop;
mod wait_any;
mod waiting;

use pyo3::prelude::*;

/// The native part of the package `scl`.
#[pymodule(gil_used = false)]
mod _native {
    #[pymodule_export]
    use super::component::Component;
    #[pymodule_export]
    use super::gate::Gate;
    #[pymodule_export]
    use super::logging::{forked, log_end, log_hold, log_level, log_release, log_start, log_take, log_wait};
    #[pymodule_export]
    use super::pending_call::PendingCall;
    #[pymodule_export]
    use super::pending_count::PendingCount;
    #[pymodule_export]
    use super::plain::is_plain;
    #[pymodule_export]
    use super::plan::{Plan, unknown_gate};
    #[pymodule_export]
    use super::process::exiting;
    #[pymodule_export]
    use super::readiness::Readiness;
    #[pymodule_export]
    use super::request::Request;
    #[pymodule_export]
    use super::stop::{stop_handle, stop_request, stop_requested, stop_within};
    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
