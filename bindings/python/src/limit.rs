//! How long a call may take, in the form that Python passes it: seconds, `None` for no limit, 0 to not wait at all.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use std::time::{Duration, Instant};

/// The time limit of a call that has begun.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Limit {
    began: Instant,
    /// `None` for no limit.
    length: Option<Duration>,
    /// How long the caller had waited before.
    before: Duration,
}

impl Limit {
    pub(crate) fn of_seconds(seconds: Option<f64>) -> PyResult<Self> {
        let length = match seconds {
            None => None,
            Some(seconds) if seconds.is_nan() || seconds < 0.0 => {
                let text = format!("timeout={seconds}; expected seconds, 0 to not wait, or None for no limit");
                return Err(PyValueError::new_err(text));
            }
            // A timeout that is too long for a `Duration` means no limit.
            Some(seconds) => Duration::try_from_secs_f64(seconds).ok(),
        };
        Ok(Self { began: Instant::now(), length, before: Duration::ZERO })
    }

    /// Sets how many seconds the caller has already waited elsewhere.
    pub(crate) fn after(self, waited: Option<f64>) -> Self {
        let before = waited.and_then(|seconds| Duration::try_from_secs_f64(seconds).ok());
        Self { before: before.unwrap_or_default(), ..self }
    }

    /// Returns true if the call must not wait.
    pub(crate) fn is_zero(&self) -> bool {
        self.length == Some(Duration::ZERO)
    }

    pub(crate) fn is_over(&self) -> bool {
        self.length.is_some_and(|length| self.began.elapsed() >= length)
    }

    /// The time that is left, but no more than `longest`.
    pub(crate) fn left(&self, longest: Duration) -> Duration {
        self.length.map_or(longest, |length| length.saturating_sub(self.began.elapsed()).min(longest))
    }

    /// Returns how long the call has waited, for error texts.
    pub(crate) fn waited(&self) -> Duration {
        self.before + self.length.unwrap_or_else(|| self.began.elapsed())
    }
}
