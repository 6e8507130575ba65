//! A gate of any kind, with bytes as its messages.

use crate::claimed::{Claim, Claimed, Unusable};
use crate::failure::{Failure, no_panic};
use crate::limit::Limit;
use crate::native::Native;
use crate::pending_call::PendingCall;
use crate::pending_count::PendingCount;
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
use std::task::{Context, Poll};
use std::time::Duration;

/// A gate of any kind. Calls that do not fit the kind fail; the Python package does not offer them.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Gate {
    plan: GatePlan,
    /// Whether a full queue of a peer can make the gate wait.
    may_wait: bool,
    pub(crate) shared: Arc<Shared>,
    /// Dropping it may close the component, which then hands over the messages that are left.
    pub(crate) claimed: Native<Claimed>,
}

/// What arrives at a gate.
enum Received {
    Message(Bytes),
    Request(scl::Request<Bytes, Bytes>),
}

impl Gate {
    pub(crate) fn new(plan: GatePlan, shared: Arc<Shared>, gate: AnyGate) -> Self {
        let is_sender = matches!(plan.kind, GateKind::Pub | GateKind::Push);
        let claimed = shared.keep(Claimed::new(gate));
        Self { may_wait: is_sender && plan.options.backpressure, plan, shared, claimed }
    }

    /// Claims the gate for a call. Fails if another call uses it, or as [`Shared::check`] does.
    pub(crate) fn claim(&self) -> Result<Claim<'_>, Failure> {
        self.shared.check()?;
        self.claimed.claim().map_err(|unusable| self.unusable(unusable))
    }

    pub(crate) fn unusable(&self, unusable: Unusable) -> Failure {
        if unusable == Unusable::Closed {
            return self.shared.ended();
        }
        let text = "is in use by another thread or task; use each gate from one thread or task at a time";
        Failure::new("Busy", format!("gate `{}` {text}", self.full_name()))
    }

    /// Inspects the gate, also while a call uses it.
    fn visit<R>(&self, look: impl FnOnce(&mut AnyGate) -> R) -> Result<R, Failure> {
        self.claimed.visit(look).map_err(|unusable| self.unusable(unusable))
    }

    /// Returns the name of the gate in error texts: `component.gate`.
    pub(crate) fn full_name(&self) -> String {
        format!("{}.{}", self.shared.component, self.plan.name)
    }

    pub(crate) fn has_no<R>(&self, call: &str) -> Result<R, Failure> {
        let text = format!("gate `{}` is a `{}` gate and has no `{call}`", self.full_name(), self.plan.kind.word());
        Err(Failure::new("WrongDirection", text))
    }

    /// Makes a call that does not wait, so it does not release the interpreter.
    fn at_once<R>(&self, step: impl FnOnce(&mut AnyGate) -> Result<R, Failure>) -> Result<R, Failure> {
        let mut claim = self.claim()?;
        no_panic(|| claim.step(step).map_err(|unusable| self.unusable(unusable))?)
    }

    /// Makes a call that tries at once and, if that was not enough, releases the interpreter and waits. Returns
    /// `Ok(None)` when the time is over.
    fn try_then_wait<R: Send>(
        &self,
        py: Python<'_>,
        limit: Limit,
        attempt: impl FnOnce(&mut AnyGate) -> Result<Option<R>, Failure>,
        mut wait_for: impl FnMut(&mut AnyGate, Duration) -> Result<Option<R>, Failure> + Send,
    ) -> PyResult<Option<R>> {
        let mut claim = self.claim()?;
        let done = no_panic(|| claim.step(attempt).map_err(|unusable| self.unusable(unusable))?)?;
        if done.is_some() || limit.is_zero() {
            return Ok(done);
        }
        wait(py, limit, &self.shared, |within| {
            claim.next_step(|gate| wait_for(gate, within)).map_err(|unusable| self.unusable(unusable))?
        })
    }

    fn try_send(&self, gate: &mut AnyGate, message: &Bytes) -> Result<(), Failure> {
        match gate {
            AnyGate::Pub(gate) => Ok(gate.try_send(message)?),
            AnyGate::Push(gate) => Ok(gate.try_send(message)?),
            _ => self.has_no("send"),
        }
    }

    fn try_receive(&self, gate: &mut AnyGate) -> Result<Option<Received>, Failure> {
        match gate {
            AnyGate::Sub(gate) => Ok(gate.try_recv()?.map(Received::Message)),
            AnyGate::Pull(gate) => Ok(gate.try_recv()?.map(Received::Message)),
            AnyGate::Rep(gate) => Ok(gate.try_recv()?.map(Received::Request)),
            _ => self.has_no("recv"),
        }
    }

    fn receive(&self, gate: &mut AnyGate, within: Duration) -> Result<Result<Received, RecvTimeoutError>, Failure> {
        match gate {
            AnyGate::Sub(gate) => Ok(gate.recv_timeout(within).map(Received::Message)),
            AnyGate::Pull(gate) => Ok(gate.recv_timeout(within).map(Received::Message)),
            AnyGate::Rep(gate) => Ok(gate.recv_timeout(within).map(Received::Request)),
            _ => self.has_no("recv"),
        }
    }

    /// Converts what was received into a Python object.
    fn to_python<'py>(&self, py: Python<'py>, received: Received) -> PyResult<Bound<'py, PyAny>> {
        match received {
            Received::Message(message) => Ok(PyBytes::new(py, &message).into_any()),
            Received::Request(request) => {
                Ok(Bound::new(py, Request::new(request, Arc::clone(&self.shared)))?.into_any())
            }
        }
    }

    /// Receives within a time limit. When it is over, a last attempt finds the reason.
    fn wait_to_receive(&self, py: Python<'_>, limit: Limit) -> PyResult<Received> {
        let wait_for = |gate: &mut AnyGate, within| match self.receive(gate, within)? {
            Ok(received) => Ok(Some(received)),
            Err(RecvTimeoutError::Timeout { .. }) => Ok(None),
            Err(error) => Err(error.into()),
        };
        if let Some(received) = self.try_then_wait(py, limit, |gate| self.try_receive(gate), wait_for)? {
            return Ok(received);
        }
        let waited = limit.waited();
        let last = self.at_once(|gate| self.receive(gate, Duration::ZERO))?;
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
            // Try one last time; if the queue is still full, the error names the peer.
            None => Ok(self.at_once(|gate| self.try_send(gate, &message))?),
        }
    }

    /// Sends and returns true, or returns false if a queue is full; `readiness` then reports when to try again.
    fn poll_send(&self, message: &Bound<'_, PyBytes>, readiness: &Readiness) -> PyResult<bool> {
        let message = Bytes::copy_from_slice(message.as_bytes());
        let sent = self.at_once(|gate| {
            let full = match self.try_send(gate, &message) {
                Err(failure) if failure.is("Full") => failure,
                sent => return sent.map(|()| true),
            };
            let waker = readiness.readiness.waker();
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

    /// Waits for a message or a request. `waited` is the time in seconds that an event loop has waited before, for the
    /// error text.
    #[pyo3(signature = (timeout=None, waited=None))]
    fn recv<'py>(&self, py: Python<'py>, timeout: Option<f64>, waited: Option<f64>) -> PyResult<Bound<'py, PyAny>> {
        let limit = Limit::of_seconds(timeout)?.after(waited);
        self.to_python(py, self.wait_to_receive(py, limit)?)
    }

    fn try_recv<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let received = self.at_once(|gate| self.try_receive(gate))?;
        received.map(|received| self.to_python(py, received)).transpose()
    }

    fn latest<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let newest = self.at_once(|gate| match gate {
            AnyGate::Sub(gate) => Ok(gate.latest()?),
            AnyGate::Pull(gate) => Ok(gate.latest()?),
            _ => self.has_no("latest"),
        })?;
        Ok(newest.map(|message| PyBytes::new(py, &message)))
    }

    /// Returns how many messages the gate has missed since the last time, and does not wait.
    fn take_missed(&self) -> PyResult<u64> {
        Ok(self.at_once(|gate| match gate {
            AnyGate::Sub(gate) => Ok(gate.take_missed()?),
            AnyGate::Pull(gate) => Ok(gate.take_missed()?),
            _ => self.has_no("take_missed"),
        })?)
    }

    /// Starts to wait until the gate has missed messages.
    fn wait_missed(&self) -> PyResult<PendingCount> {
        self.shared.check()?;
        // Do not claim the gate: it may receive meanwhile.
        let pending = self.visit(|gate| match gate {
            AnyGate::Sub(gate) => Ok(PendingCount::new(Arc::clone(&self.shared), gate.deadline_missed())),
            AnyGate::Pull(gate) => Ok(PendingCount::new(Arc::clone(&self.shared), gate.deadline_missed())),
            _ => self.has_no("deadline_missed"),
        })??;
        Ok(pending)
    }

    /// Returns a message or a request, or `None` if none has arrived; `readiness` then reports when to try again.
    fn poll_recv<'py>(&self, py: Python<'py>, readiness: &Readiness) -> PyResult<Option<Bound<'py, PyAny>>> {
        let received = self.at_once(|gate| {
            if let Some(received) = self.try_receive(gate)? {
                return Ok(Some(received));
            }
            let waker = readiness.readiness.waker();
            match gate.receiving().map(|gate| gate.poll_ready(&mut Context::from_waker(&waker))) {
                Some(Poll::Ready(ready)) => {
                    ready?;
                    self.try_receive(gate)
                }
                _ => Ok(None),
            }
        })?;
        received.map(|received| self.to_python(py, received)).transpose()
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
        let driver = &self.shared.driver;
        let reply = wait(py, Limit::of_seconds(None)?, &self.shared, |within| call.drive(driver, within))?;
        let reply = reply.ok_or_else(|| self.shared.ended())?;
        Ok(PyBytes::new(py, &reply))
    }

    /// Starts a call and returns it. Nothing is sent until the result is polled for the reply.
    #[pyo3(signature = (request, timeout=None))]
    fn start_call(&self, request: &Bound<'_, PyBytes>, timeout: Option<f64>) -> PyResult<PendingCall> {
        let timeout = timeout.map(|seconds| Limit::of_seconds(Some(seconds))).transpose()?;
        let timeout = timeout.map(|limit| limit.left(Duration::MAX));
        let request = Bytes::copy_from_slice(request.as_bytes());
        self.shared.check()?;
        // Do not claim the gate: several calls may be in progress.
        let requester = self.visit(|gate| match gate {
            AnyGate::Req(requester) => Ok(requester.clone()),
            _ => self.has_no("call"),
        })??;
        Ok(PendingCall::start(Arc::clone(&self.shared), requester, request, timeout))
    }

    #[getter]
    fn is_connected(&self, py: Python<'_>) -> PyResult<bool> {
        self.shared.check_open()?;
        Ok(detach(py, || self.visit(|gate| gate.is_connected()))??)
    }

    /// The age, in seconds, of the message received last, if it was latched before this gate connected.
    #[getter]
    fn latched_age(&self, py: Python<'_>) -> PyResult<Option<f64>> {
        self.shared.check_open()?;
        let age = detach(py, || self.visit(|gate| gate.latched_age()))??;
        Ok(age.map(|age| age.as_secs_f64()))
    }

    /// The gate that sent the message received last, as `component.gate`.
    #[getter]
    fn sender(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.shared.check_open()?;
        let last = detach(py, || self.visit(|gate| gate.last_connection()))??;
        Ok(last.map(|last| format!("{}.{}", last.peer_component, last.peer_gate)))
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.shared.check_open()?;
        let (stats, peers) = detach(py, || self.visit(|gate| (gate.stats(), gate.peer_stats())))??;
        stats::to_dict(py, &stats, &peers)
    }

    fn __repr__(&self) -> String {
        let payload = match &self.plan.payload {
            Payload::Bytes => String::new(),
            payload => format!(" of {payload}"),
        };
        format!("<{} gate {}{payload}>", self.plan.kind.word(), self.full_name())
    }
}
