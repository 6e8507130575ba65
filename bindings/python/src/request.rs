//! An incoming request that waits for its reply.

use crate::failure::{Failure, no_panic};
use crate::native::Native;
use crate::shared::Shared;
use bytes::Bytes;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use std::sync::{Arc, Mutex, PoisonError};

/// A received request. It may be answered later, from any thread, in any order.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Request {
    message: Bytes,
    shared: Arc<Shared>,
    /// `None` once answered.
    request: Native<Mutex<Option<scl::Request<Bytes, Bytes>>>>,
}

impl Request {
    pub(crate) fn new(request: scl::Request<Bytes, Bytes>, shared: Arc<Shared>) -> Self {
        Self { message: request.message().clone(), request: shared.keep(Mutex::new(Some(request))), shared }
    }

    /// Takes the request out. Returns `None` if it was answered before.
    pub(crate) fn take(&self) -> Option<scl::Request<Bytes, Bytes>> {
        self.request.lock().unwrap_or_else(PoisonError::into_inner).take()
    }
}

#[pymethods]
impl Request {
    #[getter]
    fn data<'py>(&self, py: Python<'py>) -> Bound<'py, PyBytes> {
        PyBytes::new(py, &self.message)
    }

    fn reply(&self, message: &Bound<'_, PyBytes>) -> PyResult<()> {
        // Do not check for a stop request: the requester is still waiting for the reply.
        if self.shared.is_inherited() {
            self.shared.check_open()?;
        }
        let request = self.take().ok_or_else(|| Failure::new("Answered", "this request was already answered"))?;
        Ok(no_panic(|| Ok(request.reply(&Bytes::copy_from_slice(message.as_bytes()))?))?)
    }
}
