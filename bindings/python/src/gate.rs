//! A gate of any kind, with bytes as its messages.

use crate::claimed::{Claim, Claimed, StepError, Unusable};
use crate::failure::{Failure, no_panic};
use crate::limit::Limit;
use crate::native::Native;
use crate::pending_call::PendingCall;
use crate::process::detach;
use crate::readiness::Readiness;
use crate::request::Request;
use crate::shared::Shared;
use crate::stats;
use crate::waiting::wait;
use bytes::Bytes;
use futures_sink::Sink;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use scl::RecvTimeoutError;
use scl::plan::{GateKind, GatePlan, Payload};
use scl::untyped::Gate as AnyGate;
use std::pin::Pin;
use std::sync::Arc;
use std::task::Context;
use std::time::Duration;

/// A gate. Which calls it has depends on its kind; the package offers no others.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Gate {
    plan: GatePlan,
    /// Whether a full queue of a peer can make the gate wait.
    may_wait: bool,
    shared: Arc<Shared>,
    /// Its component may end with it, and then hands over what is left.
    gate: Native<Claimed>,
}

impl Gate {
    pub(crate) fn new(plan: GatePlan, shared: Arc<Shared>, gate: AnyGate) -> Self {
        let is_sender = matches!(plan.kind, GateKind::Pub | GateKind::Push);
        let gate = shared.keep(Claimed::new(gate));
        Self { may_wait: is_sender && plan.options.backpressure, plan, shared, gate }
    }

    pub(crate) fn shared(&self) -> &Arc<Shared> {
        &self.shared
    }

    pub(crate) fn claimed(&self) -> &Claimed {
        &self.gate
    }

    /// The gate, unless another thread uses it.
    pub(crate) fn claim(&self) -> Result<Claim<'_>, Failure> {
        self.shared.check()?;
        self.gate.claim().map_err(|unusable| self.unusable(unusable))
    }

    pub(crate) fn unusable(&self, unusable: Unusable) -> Failure {
        if unusable == Unusable::Closed {
            return self.shared.ended();
        }
        let text = "is in use by another thread or task; one at a time may use a gate, others may use other gates";
        Failure::new("Busy", format!("gate `{}` {text}", self.full_name()))
    }

    pub(crate) fn failed(&self, error: StepError) -> Failure {
        match error {
            StepError::Unusable(unusable) => self.unusable(unusable),
            StepError::Failed(failure) => failure,
        }
    }

    /// As it is called in messages.
    pub(crate) fn full_name(&self) -> String {
        format!("{}.{}", self.shared.component, self.plan.name)
    }

    pub(crate) fn has_no<R>(&self, call: &str) -> Result<R, Failure> {
        let text = format!("gate `{}` is a `{}` gate and has no `{call}`", self.full_name(), self.plan.kind.word());
        Err(Failure::new("WrongDirection", text))
    }

    /// A call that does not wait, so it keeps the interpreter.
    fn at_once<R>(&self, step: impl FnOnce(&mut AnyGate) -> Result<R, Failure>) -> Result<R, Failure> {
        let mut claim = self.claim()?;
        no_panic(|| claim.step(step).map_err(|error| self.failed(error)))
    }

    /// A call that tries at once, and if that was not enough, waits without the interpreter. `Ok(None)` when the time
    /// is over.
    fn try_then_wait<R: Send>(
        &self,
        py: Python<'_>,
        limit: Limit,
        attempt: impl FnOnce(&mut AnyGate) -> Result<Option<R>, Failure>,
        mut wait_for: impl FnMut(&mut AnyGate, Duration) -> Result<Option<R>, Failure> + Send,
    ) -> PyResult<Option<R>> {
        let mut claim = self.claim()?;
        let done = no_panic(|| claim.step(attempt).map_err(|error| self.failed(error)))?;
        if done.is_some() || limit.is_zero() {
            return Ok(done);
        }
        wait(py, limit, &self.shared, |within| {
            claim.next_step(|gate| wait_for(gate, within)).map_err(|error| self.failed(error))
        })
    }

    fn try_send(&self, gate: &mut AnyGate, message: &Bytes) -> Result<(), Failure> {
        match gate {
            AnyGate::Pub(gate) => Ok(gate.try_send(message)?),
            AnyGate::Push(gate) => Ok(gate.try_send(message)?),
            _ => self.has_no("send"),
        }
    }

    fn try_receive(&self, gate: &mut AnyGate) -> Result<Option<Bytes>, Failure> {
        match gate {
            AnyGate::Sub(gate) => Ok(gate.try_recv()?),
            AnyGate::Pull(gate) => Ok(gate.try_recv()?),
            _ => self.has_no("recv"),
        }
    }

    fn try_take_request(&self, gate: &mut AnyGate) -> Result<Option<scl::Request<Bytes, Bytes>>, Failure> {
        match gate {
            AnyGate::Rep(gate) => Ok(gate.try_recv()?),
            _ => self.has_no("recv_request"),
        }
    }

    /// What a gate has, or else `None`, and then the readiness reports when it has something.
    fn poll_received<R>(
        &self,
        readiness: &Readiness,
        take: impl Fn(&mut AnyGate) -> Result<Option<R>, Failure>,
    ) -> Result<Option<R>, Failure> {
        self.at_once(|gate| {
            if let Some(taken) = take(gate)? {
                return Ok(Some(taken));
            }
            let waker = readiness.waker();
            match gate.receiving().map(|gate| gate.poll_ready(&mut Context::from_waker(&waker))) {
                Some(std::task::Poll::Ready(ready)) => {
                    ready?;
                    take(gate)
                }
                _ => Ok(None),
            }
        })
    }

    /// Receives within a limit. When it is over, the last attempt finds the reason.
    fn wait_to_receive<R: Send>(
        &self,
        py: Python<'_>,
        limit: Limit,
        attempt: impl FnOnce(&Self, &mut AnyGate) -> Result<Option<R>, Failure>,
        receive: impl Fn(&Self, &mut AnyGate, Duration) -> Result<Result<R, RecvTimeoutError>, Failure> + Sync,
    ) -> PyResult<R> {
        let wait_for = |gate: &mut AnyGate, within| match receive(self, gate, within)? {
            Ok(received) => Ok(Some(received)),
            Err(RecvTimeoutError::Timeout { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        };
        if let Some(received) = self.try_then_wait(py, limit, |gate| attempt(self, gate), wait_for)? {
            return Ok(received);
        }
        let waited = limit.waited();
        let last = self.at_once(|gate| receive(self, gate, Duration::ZERO))?;
        Ok(last.map_err(|error| match error {
            RecvTimeoutError::Timeout { gate, peers, reason, .. } if waited.is_zero() => {
                let reason = reason.map_or_else(String::new, |reason| format!(": {reason}"));
                Failure::new("Timeout", format!("gate `{gate}` has received nothing from {peers}{reason}"))
            }
            RecvTimeoutError::Timeout { gate, peers, reason, .. } => {
                RecvTimeoutError::Timeout { gate, peers, reason, waited }.into()
            }
            error => error.into(),
        })?)
    }

    fn receive(&self, gate: &mut AnyGate, within: Duration) -> Result<Result<Bytes, RecvTimeoutError>, Failure> {
        match gate {
            AnyGate::Sub(gate) => Ok(gate.recv_timeout(within)),
            AnyGate::Pull(gate) => Ok(gate.recv_timeout(within)),
            _ => self.has_no("recv"),
        }
    }

    fn take_request(
        &self,
        gate: &mut AnyGate,
        within: Duration,
    ) -> Result<Result<scl::Request<Bytes, Bytes>, RecvTimeoutError>, Failure> {
        match gate {
            AnyGate::Rep(gate) => Ok(gate.recv_timeout(within)),
            _ => self.has_no("recv_request"),
        }
    }
}

#[pymethods]
impl Gate {
    #[getter]
    fn name(&self) -> &str {
        &self.plan.name
    }

    #[getter]
    fn component(&self) -> &str {
        &self.shared.component
    }

    /// `pub`, `sub`, `req`, `rep`, `push` or `pull`.
    #[getter]
    fn kind(&self) -> &'static str {
        self.plan.kind.word()
    }

    #[getter]
    fn declared_at(&self) -> &str {
        &self.plan.declared_at
    }

    /// The timeout of a `req` gate, in seconds.
    #[getter]
    fn timeout(&self) -> f64 {
        self.plan.options.timeout.as_secs_f64()
    }

    #[pyo3(signature = (message, timeout=None))]
    fn send(&self, py: Python<'_>, message: &Bound<'_, PyBytes>, timeout: Option<f64>) -> PyResult<()> {
        let limit = Limit::of_seconds(timeout)?;
        let message = Bytes::copy_from_slice(message.as_bytes());
        if !self.may_wait || limit.is_zero() {
            return Ok(self.at_once(|gate| self.try_send(gate, &message))?);
        }
        let attempt = |gate: &mut AnyGate| match self.try_send(gate, &message) {
            Err(failure) if failure.is("Full") => Ok(None),
            sent => sent.map(Some),
        };
        let sent = self.try_then_wait(py, limit, attempt, |gate, within| {
            let sent = match gate {
                AnyGate::Pub(gate) => gate.send_timeout(&message, within),
                AnyGate::Push(gate) => gate.send_timeout(&message, within),
                _ => return self.has_no("send"),
            };
            match sent {
                Err(scl::SendTimeoutError::Timeout { .. }) => Ok(None),
                sent => Ok(Some(sent?)),
            }
        })?;
        match sent {
            Some(()) => Ok(()),
            // One last time, which also names the peer.
            None => Ok(self.at_once(|gate| self.try_send(gate, &message))?),
        }
    }

    /// Sends, or returns false, and then the readiness reports when it may succeed.
    fn poll_send(&self, message: &Bound<'_, PyBytes>, readiness: &Readiness) -> PyResult<bool> {
        let message = Bytes::copy_from_slice(message.as_bytes());
        let sent = self.at_once(|gate| {
            let full = match self.try_send(gate, &message) {
                Err(failure) if failure.is("Full") => failure,
                sent => return sent.map(|()| true),
            };
            let waker = readiness.waker();
            let cx = &mut Context::from_waker(&waker);
            let room = match gate {
                AnyGate::Pub(gate) => Pin::new(gate).poll_ready(cx),
                AnyGate::Push(gate) => Pin::new(gate).poll_ready(cx),
                _ => return Err(full),
            };
            if room.is_pending() {
                return Ok(false);
            }
            self.try_send(gate, &message).map(|()| true)
        })?;
        Ok(sent)
    }

    /// Waits for a message. `waited` is for the message of the error, if an event loop has waited before.
    #[pyo3(signature = (timeout=None, waited=None))]
    fn recv<'py>(&self, py: Python<'py>, timeout: Option<f64>, waited: Option<f64>) -> PyResult<Bound<'py, PyBytes>> {
        let limit = Limit::of_seconds(timeout)?.after(waited);
        Ok(PyBytes::new(py, &self.wait_to_receive(py, limit, Self::try_receive, Self::receive)?))
    }

    fn try_recv<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let received = self.at_once(|gate| self.try_receive(gate))?;
        Ok(received.map(|message| PyBytes::new(py, &message)))
    }

    fn latest<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let newest = self.at_once(|gate| match gate {
            AnyGate::Sub(gate) => Ok(gate.latest()?),
            AnyGate::Pull(gate) => Ok(gate.latest()?),
            _ => self.has_no("latest"),
        })?;
        Ok(newest.map(|message| PyBytes::new(py, &message)))
    }

    /// Returns a message, or `None`, and then the readiness reports when there may be one.
    fn poll_recv<'py>(&self, py: Python<'py>, readiness: &Readiness) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let received = self.poll_received(readiness, |gate| self.try_receive(gate))?;
        Ok(received.map(|message| PyBytes::new(py, &message)))
    }

    /// As `recv`, at a `rep` gate.
    #[pyo3(signature = (timeout=None, waited=None))]
    fn recv_request(&self, py: Python<'_>, timeout: Option<f64>, waited: Option<f64>) -> PyResult<Request> {
        let limit = Limit::of_seconds(timeout)?.after(waited);
        let taken = self.wait_to_receive(py, limit, Self::try_take_request, Self::take_request)?;
        Ok(Request::new(taken, Arc::clone(&self.shared)))
    }

    fn try_recv_request(&self) -> PyResult<Option<Request>> {
        let taken = self.at_once(|gate| self.try_take_request(gate))?;
        Ok(taken.map(|request| Request::new(request, Arc::clone(&self.shared))))
    }

    /// Returns a request, or `None`, and then the readiness reports when there may be one.
    fn poll_recv_request(&self, readiness: &Readiness) -> PyResult<Option<Request>> {
        let taken = self.poll_received(readiness, |gate| self.try_take_request(gate))?;
        Ok(taken.map(|request| Request::new(request, Arc::clone(&self.shared))))
    }

    /// Reports that the package could not decode the message or reply that the gate received last, or this request.
    /// Returns true if the gate skips such messages.
    #[pyo3(signature = (reason, request=None))]
    fn reject(&self, reason: String, request: Option<&Bound<'_, Request>>) -> PyResult<bool> {
        let request = request.and_then(|request| request.get().take());
        Ok(self.at_once(|gate| match request {
            Some(request) => Ok(gate.reject_request(request, reason).is_ok()),
            None => Ok(gate.reject(reason).is_ok()),
        })?)
    }

    /// Sends a request and waits for the reply.
    #[pyo3(signature = (request, timeout=None))]
    fn call<'py>(
        &self,
        py: Python<'py>,
        request: &Bound<'_, PyBytes>,
        timeout: Option<f64>,
    ) -> PyResult<Bound<'py, PyBytes>> {
        let call = self.start_call(request, timeout)?;
        let driver = self.shared.driver();
        let reply = wait(py, Limit::of_seconds(None)?, &self.shared, |within| call.drive(&driver, within))?;
        let reply = reply.ok_or_else(|| self.shared.ended())?;
        Ok(PyBytes::new(py, &reply))
    }

    /// Sends a request. The reply comes from the result, which must be asked for it before anything is sent.
    #[pyo3(signature = (request, timeout=None))]
    fn start_call(&self, request: &Bound<'_, PyBytes>, timeout: Option<f64>) -> PyResult<PendingCall> {
        let timeout = timeout.map(|seconds| Limit::of_seconds(Some(seconds))).transpose()?;
        let timeout = timeout.map(|limit| limit.left(Duration::MAX));
        let request = Bytes::copy_from_slice(request.as_bytes());
        self.shared.check()?;
        // Not claimed: several calls may be in progress.
        let requester = self.gate.visit(|gate| match gate {
            AnyGate::Req(requester) => Ok(requester.clone()),
            _ => self.has_no("call"),
        });
        let requester = requester.map_err(|unusable| self.unusable(unusable))??;
        Ok(PendingCall::start(Arc::clone(&self.shared), requester, request, timeout))
    }

    #[getter]
    fn is_connected(&self, py: Python<'_>) -> PyResult<bool> {
        self.shared.check_open()?;
        let connected = detach(py, || self.gate.visit(|gate| gate.is_connected()))?;
        Ok(connected.map_err(|unusable| self.unusable(unusable))?)
    }

    /// In seconds.
    #[getter]
    fn latched_age(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.shared.check_open()?;
        let age = py.detach(|| self.gate.visit(|gate| gate.latched_age()));
        Ok(age.map_err(|unusable| self.unusable(unusable))?.map(|age| age.as_secs_f64()))
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.shared.check_open()?;
        let stats = detach(py, || self.gate.visit(|gate| stats::of_gate(gate)))?;
        stats.map_err(|unusable| self.unusable(unusable))?.to_dict(py)
    }

    fn __repr__(&self) -> String {
        let payload = match &self.plan.payload {
            Payload::Bytes => String::new(),
            payload => format!(" of {payload}"),
        };
        format!("<{} gate {}{payload}>", self.plan.kind.word(), self.full_name())
    }
}
