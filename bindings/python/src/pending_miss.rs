//! Waiting for messages that do not come, in steps.

use crate::failure::no_panic;
use crate::native::Native;
use crate::readiness::Readiness;
use crate::shared::Shared;
use pyo3::prelude::*;
use scl::RecvError;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};

/// A task that waits until a gate has missed messages.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct PendingMiss {
    shared: Arc<Shared>,
    wait: Native<Mutex<Wait>>,
}

type Wait = Pin<Box<dyn Future<Output = Result<u64, RecvError>> + Send>>;

impl PendingMiss {
    pub(crate) fn new(
        shared: Arc<Shared>,
        wait: impl Future<Output = Result<u64, RecvError>> + Send + 'static,
    ) -> Self {
        Self { wait: shared.keep(Mutex::new(Box::pin(wait))), shared }
    }
}

#[pymethods]
impl PendingMiss {
    /// Returns how many messages are missing, or `None` if none is; `readiness` then reports when to try again. It must
    /// not be called again after it has returned a number.
    fn poll(&self, readiness: &Readiness) -> PyResult<Option<u64>> {
        self.shared.check()?;
        let waker = readiness.readiness.waker();
        let missed = no_panic(|| {
            let mut wait = self.wait.lock().unwrap_or_else(PoisonError::into_inner);
            match wait.as_mut().poll(&mut Context::from_waker(&waker)) {
                Poll::Ready(missed) => Ok(Some(missed?)),
                Poll::Pending => Ok(None),
            }
        })?;
        Ok(missed)
    }
}
