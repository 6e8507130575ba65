//! A gate of any kind, with bytes as its messages.

use crate::claimed::{Claim, Claimed};
use crate::failure::{Failure, no_panic};
use crate::limit::Limit;
use crate::request::Request;
use crate::shared::Shared;
use crate::stats;
use crate::waiting::wait;
use bytes::Bytes;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use scl::RecvTimeoutError;
use scl::plan::{GateKind, GatePlan, Payload};
use scl::untyped::Gate as AnyGate;
use std::sync::Arc;
use std::time::Duration;

/// A gate. Which calls it has depends on its kind; the package offers no others.
#[pyclass(frozen, module = "scl._native")]
pub(crate) struct Gate {
    plan: GatePlan,
    /// Whether a full queue of a peer can make the gate wait.
    may_wait: bool,
    shared: Arc<Shared>,
    gate: Claimed,
}

impl Gate {
    pub(crate) fn new(plan: GatePlan, shared: Arc<Shared>, gate: AnyGate) -> Self {
        let is_sender = matches!(plan.kind, GateKind::Pub | GateKind::Push);
        Self { may_wait: is_sender && plan.options.backpressure, plan, shared, gate: Claimed::new(gate) }
    }

    /// Takes the gate away from Python, once the step of the call that uses it has ended.
    pub(crate) fn close(&self) {
        self.gate.close();
    }

    /// The gate, unless another thread uses it.
    fn claim(&self) -> Result<Claim<'_>, Failure> {
        self.shared.check()?;
        self.gate.claim().ok_or_else(|| {
            let text = "is in use by another thread; one thread at a time may use a gate, others may use other gates";
            Failure::new("Busy", format!("gate `{}` {text}", self.full_name()))
        })
    }

    /// A call that does not wait, so it keeps the interpreter.
    fn at_once<R>(&self, step: impl FnOnce(&mut AnyGate) -> Result<R, Failure>) -> Result<R, Failure> {
        let mut claim = self.claim()?;
        no_panic(|| claim.step(step).unwrap_or_else(|| Err(self.shared.closed())))
    }

    /// A call that tries at once, and if that was not enough, waits without the interpreter. `Ok(None)` when the time is over.
    fn try_then_wait<R: Send>(
        &self,
        py: Python<'_>,
        limit: Limit,
        mut attempt: impl FnMut(&mut AnyGate) -> Result<Option<R>, Failure> + Send,
        mut wait_for: impl FnMut(&mut AnyGate, Duration) -> Result<Option<R>, Failure> + Send,
    ) -> PyResult<Option<R>> {
        let mut claim = self.claim()?;
        let closed = || Err(self.shared.closed());
        let done = no_panic(|| claim.step(&mut attempt).unwrap_or_else(closed))?;
        if done.is_some() || limit.is_zero() {
            return Ok(done);
        }
        wait(py, limit, &self.shared, |within| claim.next_step(|gate| wait_for(gate, within)).unwrap_or_else(closed))
    }

    /// As it is called in messages.
    fn full_name(&self) -> String {
        format!("{}.{}", self.shared.component, self.plan.name)
    }

    fn has_no<R>(&self, call: &str) -> Result<R, Failure> {
        let text = format!("gate `{}` is a `{}` gate and has no `{call}`", self.full_name(), self.plan.kind.word());
        Err(Failure::new("WrongDirection", text))
    }

    fn try_send(&self, gate: &mut AnyGate, message: &Bytes) -> Result<(), Failure> {
        match gate {
            AnyGate::Pub(gate) => Ok(gate.try_send(message)?),
            AnyGate::Push(gate) => Ok(gate.try_send(message)?),
            _ => self.has_no("send"),
        }
    }

    fn try_recv_from(&self, gate: &mut AnyGate) -> Result<Option<Bytes>, Failure> {
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

    /// The error of a receiving call whose time is over, with the reason.
    fn nothing_received(&self, limit: Limit) -> Failure {
        let ask_why = |gate: &mut AnyGate| {
            Ok(match gate {
                AnyGate::Sub(gate) => gate.recv_timeout(Duration::ZERO).err(),
                AnyGate::Pull(gate) => gate.recv_timeout(Duration::ZERO).err(),
                _ => None,
            })
        };
        match self.at_once(ask_why) {
            Ok(Some(RecvTimeoutError::Timeout { gate, peers, reason, .. })) => {
                RecvTimeoutError::Timeout { gate, peers, reason, waited: limit.waited() }.into()
            }
            Ok(Some(error)) => error.into(),
            Ok(None) => Failure::new("Timeout", format!("gate `{}` received nothing in time", self.full_name())),
            Err(failure) => failure,
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
    fn codec(&self) -> &str {
        &self.plan.codec
    }

    /// The types of its messages: none for bytes, one, or request and reply.
    #[getter]
    fn types(&self) -> Vec<&str> {
        self.plan.payload.types().collect()
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
        if !self.may_wait {
            return Ok(self.at_once(|gate| self.try_send(gate, &message))?);
        }
        let mut full = None;
        let mut attempt = |gate: &mut AnyGate| match self.try_send(gate, &message) {
            Err(failure) if failure.is("Full") => {
                full = Some(failure);
                Ok(None)
            }
            sent => sent.map(Some),
        };
        let mut claim = self.claim()?;
        let closed = || Err(self.shared.closed());
        let mut sent = no_panic(|| claim.step(&mut attempt).unwrap_or_else(closed))?;
        if sent.is_none() && !limit.is_zero() {
            sent = wait(py, limit, &self.shared, |within| {
                let sent = claim.next_step(&mut attempt).unwrap_or_else(closed);
                std::thread::sleep(Duration::from_millis(1).min(within));
                sent
            })?;
        }
        match (sent, full) {
            (None, Some(full)) => Err(full.into()),
            _ => Ok(()),
        }
    }

    #[pyo3(signature = (timeout=None))]
    fn recv<'py>(&self, py: Python<'py>, timeout: Option<f64>) -> PyResult<Bound<'py, PyBytes>> {
        let limit = Limit::of_seconds(timeout)?;
        let attempt = |gate: &mut AnyGate| self.try_recv_from(gate);
        let received = self.try_then_wait(py, limit, attempt, |gate, within| {
            let received = match gate {
                AnyGate::Sub(gate) => gate.recv_timeout(within),
                AnyGate::Pull(gate) => gate.recv_timeout(within),
                _ => return self.has_no("recv"),
            };
            unless_timeout(received)
        })?;
        match received {
            Some(message) => Ok(PyBytes::new(py, &message)),
            None => Err(self.nothing_received(limit).into()),
        }
    }

    fn try_recv<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyBytes>>> {
        let received = self.at_once(|gate| self.try_recv_from(gate))?;
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

    fn call<'py>(&self, py: Python<'py>, request: &Bound<'_, PyBytes>) -> PyResult<Bound<'py, PyBytes>> {
        let request = Bytes::copy_from_slice(request.as_bytes());
        let limit = Limit::of_seconds(None)?;
        let attempt = |_: &mut AnyGate| Ok(None);
        let reply = self.try_then_wait(py, limit, attempt, |gate, _| match gate {
            AnyGate::Req(gate) => Ok(Some(gate.call_blocking(&request)?)),
            _ => self.has_no("call"),
        })?;
        let reply = reply.ok_or_else(|| self.shared.closed())?;
        Ok(PyBytes::new(py, &reply))
    }

    #[pyo3(signature = (timeout=None))]
    fn recv_request(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<Request> {
        let limit = Limit::of_seconds(timeout)?;
        let take = |gate: &mut AnyGate| self.try_take_request(gate);
        let taken = self.try_then_wait(py, limit, take, |gate, within| {
            let taken = take(gate)?;
            if taken.is_none() {
                std::thread::sleep(Duration::from_millis(1).min(within));
            }
            Ok(taken)
        })?;
        match taken {
            Some(taken) => Ok(Request::new(taken, Arc::clone(&self.shared))),
            None => {
                let text = format!("gate `{}` received no request in time", self.full_name());
                Err(Failure::new("Timeout", text).into())
            }
        }
    }

    fn try_recv_request(&self) -> PyResult<Option<Request>> {
        let taken = self.at_once(|gate| self.try_take_request(gate))?;
        Ok(taken.map(|request| Request::new(request, Arc::clone(&self.shared))))
    }

    #[getter]
    fn is_connected(&self, py: Python<'_>) -> PyResult<bool> {
        self.shared.check_open()?;
        Ok(py.detach(|| self.gate.visit(AnyGate::is_connected)).ok_or_else(|| self.shared.closed())?)
    }

    fn stats<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.shared.check_open()?;
        let stats = py.detach(|| self.gate.visit(stats::of_gate)).ok_or_else(|| self.shared.closed())?;
        stats.to_dict(py)
    }

    fn __repr__(&self) -> String {
        let payload = match &self.plan.payload {
            Payload::Bytes => String::new(),
            payload => format!(" of {payload}"),
        };
        format!("<{} gate {}{payload}>", self.plan.kind.word(), self.full_name())
    }
}

fn unless_timeout<T>(received: Result<T, RecvTimeoutError>) -> Result<Option<T>, Failure> {
    match received {
        Ok(message) => Ok(Some(message)),
        Err(RecvTimeoutError::Timeout { .. }) => Ok(None),
        Err(error) => Err(error.into()),
    }
}
