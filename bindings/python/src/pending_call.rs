//! A request that waits for its reply, in steps.

use crate::failure::{Failure, no_panic};
use crate::native::Native;
use crate::readiness::Readiness;
use crate::shared::Shared;
use bytes::Bytes;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use scl::untyped::Driver;
use scl::{CallError, Req};
use std::future::poll_fn;
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::task::{Context, Poll, Waker};
use std::time::Duration;

/// A call of a `req` gate. Dropping it cancels the call.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct PendingCall {
    shared: Arc<Shared>,
    cancelled: Arc<AtomicBool>,
    /// `None` once it is over.
    call: Native<Mutex<Option<Call>>>,
}

type Call = Pin<Box<dyn Future<Output = Reply> + Send>>;

/// `None` if the call was cancelled.
type Reply = Option<Result<Bytes, CallError>>;

impl PendingCall {
    /// Begins a call, which sends nothing before it is polled.
    pub(crate) fn start(
        shared: Arc<Shared>,
        requester: Req<Bytes, Bytes>,
        request: Bytes,
        timeout: Option<Duration>,
    ) -> Self {
        let cancelled = Arc::new(AtomicBool::new(false));
        let call = Box::pin(exchange(requester, request, timeout, Arc::clone(&cancelled)));
        Self { call: shared.keep(Mutex::new(Some(call))), shared, cancelled }
    }

    /// Waits for the reply no longer than a given time; `None` if there is none yet.
    pub(crate) fn drive(&self, driver: &Driver, within: Duration) -> Result<Option<Bytes>, Failure> {
        self.advance(|call| Ok(driver.wait_for(call, within)?))
    }

    fn poll(&self, cx: &mut Context<'_>) -> Result<Option<Bytes>, Failure> {
        self.advance(|call| match call.poll(cx) {
            Poll::Ready(done) => Ok(Some(done)),
            Poll::Pending => Ok(None),
        })
    }

    /// Takes the call a step further; `None` if that was not the last one.
    fn advance(
        &self,
        step: impl FnOnce(Pin<&mut (dyn Future<Output = Reply> + Send)>) -> Result<Option<Reply>, Failure>,
    ) -> Result<Option<Bytes>, Failure> {
        let mut slot = self.call.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(call) = slot.as_mut() else { return Err(Failure::new("Answered", "this call is over")) };
        let Some(reply) = step(call.as_mut())? else { return Ok(None) };
        *slot = None;
        Ok(reply.transpose()?)
    }
}

#[pymethods]
impl PendingCall {
    /// Returns the reply, or `None`, and then the readiness reports when there may be one.
    fn poll_reply<'py>(&self, py: Python<'py>, readiness: &Readiness) -> PyResult<Option<Bound<'py, PyBytes>>> {
        self.shared.check()?;
        let waker = readiness.waker();
        let reply = no_panic(|| self.poll(&mut Context::from_waker(&waker)))?;
        Ok(reply.map(|reply| PyBytes::new(py, &reply)))
    }

    /// Ends the call; a reply that still comes is discarded. The gate can be used again.
    fn cancel(&self) {
        self.cancelled.store(true, Ordering::Release);
        if self.shared.is_inherited() {
            return;
        }
        let _over = no_panic(|| self.poll(&mut Context::from_waker(Waker::noop())));
    }
}

impl Drop for PendingCall {
    fn drop(&mut self) {
        self.cancel();
    }
}

async fn exchange(
    mut requester: Req<Bytes, Bytes>,
    request: Bytes,
    timeout: Option<Duration>,
    cancelled: Arc<AtomicBool>,
) -> Reply {
    let timeout = timeout.unwrap_or(requester.timeout());
    let mut call = pin!(requester.call_within(&request, timeout));
    poll_fn(|cx| match cancelled.load(Ordering::Acquire) {
        true => Poll::Ready(None),
        false => call.as_mut().poll(cx).map(Some),
    })
    .await
}
