//! Calls that wait: with the interpreter released, and checking for signals now and then.

use crate::failure::{Failure, no_panic};
use crate::limit::Limit;
use crate::process::detach;
use crate::shared::Shared;
use pyo3::prelude::*;
use std::time::Duration;

/// How long a call waits before it checks whether Ctrl-C was pressed. Python runs signal handlers in its main thread
/// only, and only between two steps of Python code, so a wait has to return to it.
pub(crate) const LOOK: Duration = Duration::from_millis(40);

/// Repeats an attempt, with the interpreter released, until it succeeds or fails. Returns `Ok(None)` when the time is
/// over.
///
/// Each attempt gets the time that it may wait; it returns `Ok(None)` if that was not enough.
pub(crate) fn wait<T: Send>(
    py: Python<'_>,
    limit: Limit,
    shared: &Shared,
    mut attempt: impl FnMut(Duration) -> Result<Option<T>, Failure> + Send,
) -> PyResult<Option<T>> {
    loop {
        let attempted = detach(py, || no_panic(|| attempt(limit.left(LOOK))))?;
        if let Some(done) = attempted? {
            return Ok(Some(done));
        }
        py.check_signals()?;
        shared.check()?;
        if limit.is_over() {
            return Ok(None);
        }
    }
}
