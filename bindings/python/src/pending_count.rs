//! Waiting for a count, in steps: of messages that do not come, or of changes of parameters.

use crate::failure::{Failure, no_panic};
use crate::native::Native;
use crate::readiness::Readiness;
use crate::shared::Shared;
use pyo3::prelude::*;
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};

/// A task that waits until something is counted.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct PendingCount {
    shared: Arc<Shared>,
    wait: Native<Mutex<Wait>>,
}

type Wait = Pin<Box<dyn Future<Output = Result<u64, Failure>> + Send>>;

impl PendingCount {
    pub(crate) fn new<E: Into<Failure>>(
        shared: Arc<Shared>,
        wait: impl Future<Output = Result<u64, E>> + Send + 'static,
    ) -> Self {
        let wait: Wait = Box::pin(async { wait.await.map_err(Into::into) });
        Self { wait: shared.keep(Mutex::new(wait)), shared }
    }
}

#[pymethods]
impl PendingCount {
    /// Returns the count, or `None` as long as there is none; `readiness` then reports when to try again. It must not
    /// be called again after it has returned a number.
    fn poll(&self, readiness: &Readiness) -> PyResult<Option<u64>> {
        self.shared.check()?;
        let waker = readiness.readiness.waker();
        let count = no_panic(|| {
            let mut wait = self.wait.lock().unwrap_or_else(PoisonError::into_inner);
            match wait.as_mut().poll(&mut Context::from_waker(&waker)) {
                Poll::Ready(count) => Ok(Some(count?)),
                Poll::Pending => Ok(None),
            }
        })?;
        Ok(count)
    }
}
