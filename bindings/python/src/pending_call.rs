//! An outgoing request that waits for its reply, in steps.

use crate::failure::{Failure, no_panic};
use crate::native::Native;
use crate::readiness::Readiness;
use crate::shared::Shared;
use bytes::Bytes;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use scl::untyped::Driver;
use scl::{CallError, Req};
use std::pin::Pin;
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll};
use std::time::Duration;

/// A call of a `req` gate. Dropping it cancels the call.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct PendingCall {
    shared: Arc<Shared>,
    /// `None` once it is over.
    call: Native<Mutex<Option<Call>>>,
}

type Call = Pin<Box<dyn Future<Output = Result<Bytes, CallError>> + Send>>;

impl PendingCall {
    /// Begins a call. Nothing is sent before it is polled.
    pub(crate) fn start(
        shared: Arc<Shared>,
        mut requester: Req<Bytes, Bytes>,
        request: Bytes,
        timeout: Option<Duration>,
    ) -> Self {
        let timeout = timeout.unwrap_or(requester.timeout());
        let call: Call = Box::pin(async move { requester.call_within(&request, timeout).await });
        Self { call: shared.keep(Mutex::new(Some(call))), shared }
    }

    /// Waits for the reply, but no longer than a given time. Returns `None` if it has not arrived yet.
    pub(crate) fn drive(&self, driver: &Driver, within: Duration) -> Result<Option<Bytes>, Failure> {
        self.advance(|call| Ok(driver.wait_for(call, within)?))
    }

    /// Advances the call by a step. Returns `None` if it is not over yet.
    fn advance(
        &self,
        step: impl FnOnce(&mut Call) -> Result<Option<Result<Bytes, CallError>>, Failure>,
    ) -> Result<Option<Bytes>, Failure> {
        let mut slot = self.call.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(call) = slot.as_mut() else { return Err(Failure::new("Answered", "this call is over")) };
        let Some(reply) = step(call)? else { return Ok(None) };
        *slot = None;
        Ok(Some(reply?))
    }
}

#[pymethods]
impl PendingCall {
    /// Returns the reply, or `None` if it has not arrived yet; `readiness` then reports when to try again.
    fn poll_reply<'py>(&self, py: Python<'py>, readiness: &Readiness) -> PyResult<Option<Bound<'py, PyBytes>>> {
        self.shared.check()?;
        let waker = readiness.readiness.waker();
        let reply = no_panic(|| {
            self.advance(|call| match call.as_mut().poll(&mut Context::from_waker(&waker)) {
                Poll::Ready(done) => Ok(Some(done)),
                Poll::Pending => Ok(None),
            })
        })?;
        Ok(reply.map(|reply| PyBytes::new(py, &reply)))
    }

    /// Ends the call; a reply that still comes is discarded. The gate can be used again.
    fn cancel(&self) {
        if !self.shared.is_inherited() {
            let _over = no_panic(|| {
                drop(self.call.lock().unwrap_or_else(PoisonError::into_inner).take());
                Ok(())
            });
        }
    }
}
