//! A component, opened from its plan.

use crate::failure::{Failure, no_panic};
use crate::gate::Gate;
use crate::limit::Limit;
use crate::native::Native;
use crate::parameter;
use crate::pending_count::PendingCount;
use crate::plan::Plan;
use crate::process::detach;
use crate::readiness::Readiness;
use crate::shared::Shared;
use crate::wait_any::wait_any;
use crate::waiting::{LOOK, wait};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use scl::host::{self, text_with_causes};
use scl::untyped;
use scl::{NotReady, OpenOptions, TransportChoiceError};
use scl_topology::rust_name::gate_field;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

/// A component whose gates carry bytes.
#[pyclass(frozen, weakref, module = "scl._native")]
pub(crate) struct Component {
    shared: Arc<Shared>,
    gates: Vec<Py<Gate>>,
    /// How often its live parameters had changed when their values were last taken over.
    taken_over: AtomicU64,
    /// `None` once closed. Dropping it hands over the messages that are left.
    component: Native<Mutex<Option<untyped::Component>>>,
    is_test: bool,
}

/// A component, and the gates that were taken out of it.
struct WithGates {
    gates: Vec<untyped::Gate>,
    component: untyped::Component,
}

#[pymethods]
impl Component {
    /// Opens a component of a system whose plans are given as JSON.
    #[staticmethod]
    #[pyo3(signature = (plan, component, *, runtime_dir=None, system=None, transport=None, set=None))]
    fn open(
        py: Python<'_>,
        plan: &Plan,
        component: &str,
        runtime_dir: Option<PathBuf>,
        system: Option<String>,
        transport: Option<&str>,
        set: Option<BTreeMap<String, String>>,
    ) -> PyResult<Self> {
        let options = with_values(options(runtime_dir, system, transport)?, set);
        let plan = plan.component(component)?;
        let opened = detach(py, || {
            no_panic(|| {
                host::notify_service_manager();
                host::apply_real_time()?;
                WithGates::of(untyped::Component::open_blocking_with(plan, options)?, plan)
            })
        })?;
        Self::new(py, plan, opened?, false)
    }

    /// Opens a component for a unit test, together with its counterpart.
    #[staticmethod]
    #[pyo3(signature = (plan, component, *, set=None))]
    fn open_test(
        py: Python<'_>,
        plan: &Plan,
        component: &str,
        set: Option<BTreeMap<String, String>>,
    ) -> PyResult<(Self, Self)> {
        let options = with_values(OpenOptions::new(), set);
        let plan = plan.component(component)?;
        let counterpart = plan.counterpart();
        let opened = detach(py, || {
            no_panic(|| {
                let (component, peer) = untyped::Component::test_blocking_with(plan, options)?;
                Ok((WithGates::of(component, plan)?, WithGates::of(peer, &counterpart)?))
            })
        })?;
        let (component, peer) = opened?;
        Ok((Self::new(py, plan, component, true)?, Self::new(py, &counterpart, peer, true)?))
    }

    #[getter]
    fn name(&self) -> &str {
        &self.shared.component
    }

    #[getter]
    fn system(&self) -> &str {
        &self.shared.system
    }

    /// The gates, in the order of the topology file.
    #[getter]
    fn gates(&self, py: Python<'_>) -> Vec<Py<Gate>> {
        self.gates.iter().map(|gate| gate.clone_ref(py)).collect()
    }

    /// The parameters, in the order of the topology file: name, name as an identifier, and value.
    #[getter]
    fn parameters(&self, py: Python<'_>) -> PyResult<Vec<(String, String, Py<PyAny>)>> {
        let read = |component: &untyped::Component| {
            let found = component.spec().parameters.iter();
            found.filter_map(|it| Some((it.name.to_string(), component.parameter(&it.name)?))).collect::<Vec<_>>()
        };
        let found = self.with(py, read)?.into_iter();
        found.map(|(name, value)| Ok((name.clone(), gate_field(&name), parameter::object(py, &value)?))).collect()
    }

    /// Returns whether live parameters have changed since the last call that returned true, and waits until one has.
    fn update_parameters(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<bool> {
        let limit = Limit::of_seconds(timeout)?;
        if timeout != Some(0.0) {
            let mut changed = Box::pin(self.with(py, |component| component.parameters_changed(self.taken_over()))?);
            let (shared, driver) = (&self.shared, &self.shared.driver);
            wait(py, limit, shared, |within| Ok(driver.wait_for(changed.as_mut(), within)?.transpose()?))?;
        }
        let changes = self.with(py, untyped::Component::parameter_changes)?;
        Ok(self.taken_over.swap(changes, Ordering::AcqRel) != changes)
    }

    /// Starts to wait until live parameters change.
    fn wait_parameters(&self, py: Python<'_>) -> PyResult<PendingCount> {
        let changed = self.with(py, |component| component.parameters_changed(self.taken_over()))?;
        Ok(PendingCount::new(Arc::clone(&self.shared), changed))
    }

    /// Sets a live parameter, as a text like in the topology file.
    fn set_parameter(&self, py: Python<'_>, name: &str, value: &str) -> PyResult<()> {
        let set = self.with(py, |component| component.set_parameter(name, value))?;
        set.map_err(|error| PyValueError::new_err(error.to_string()))
    }

    /// Waits until all required peers are connected. `waited` is the time in seconds that the caller has waited before,
    /// for the error text.
    #[pyo3(signature = (timeout=None, waited=None))]
    fn ready(&self, py: Python<'_>, timeout: Option<f64>, waited: Option<f64>) -> PyResult<()> {
        let limit = Limit::of_seconds(timeout)?.after(waited);
        self.shared.check()?;
        let mut missing: Option<NotReady> = None;
        let ready = wait(py, limit, &self.shared, |within| {
            let component = self.component.lock().unwrap_or_else(PoisonError::into_inner);
            let component = component.as_ref().ok_or_else(|| self.shared.ended())?;
            match component.ready_blocking(within) {
                Ok(()) => Ok(Some(())),
                Err(error) => {
                    let error = Box::<dyn std::error::Error + Send + Sync>::from(error);
                    missing = Some(*error.downcast::<NotReady>().map_err(|error| Failure::of(&*error))?);
                    Ok(None)
                }
            }
        })?;
        match (ready, missing) {
            (None, Some(mut missing)) => {
                if !limit.waited().is_zero() {
                    missing.waited = limit.waited();
                }
                Err(Failure::from(missing).into())
            }
            _ => Ok(()),
        }
    }

    /// Waits until at least one of the gates has a message or a request. Returns the indices of those that have, none
    /// when the time is over.
    #[pyo3(signature = (gates, timeout=None))]
    fn wait(&self, py: Python<'_>, gates: Vec<Py<Gate>>, timeout: Option<f64>) -> PyResult<Vec<usize>> {
        let limit = Limit::of_seconds(timeout)?;
        self.shared.check()?;
        let gates: Vec<&Gate> = gates.iter().map(|gate| gate.get()).collect();
        if let Some(other) = gates.iter().find(|gate| !Arc::ptr_eq(&gate.shared, &self.shared)) {
            let text = format!("gate `{}` does not belong to component `{}`", other.full_name(), self.shared.component);
            return Err(PyValueError::new_err(text));
        }
        wait_any(py, limit, &self.shared, &gates)
    }

    /// Waits until every peer that is running has taken all messages, then closes. Calls that wait end with `Closed`.
    #[pyo3(signature = (timeout=None))]
    fn close(&self, py: Python<'_>, timeout: Option<f64>) -> PyResult<()> {
        let limit = Limit::of_seconds(timeout)?;
        if self.shared.is_inherited() || self.shared.close() {
            return Ok(());
        }
        let component = detach(py, || {
            self.gates.iter().for_each(|gate| gate.get().claimed.close());
            self.component.lock().unwrap_or_else(PoisonError::into_inner).take()
        })?;
        let Some(component) = component else { return Ok(()) };
        // Close on a separate thread, so Ctrl-C can interrupt the wait; the thread then continues the flush.
        let (done, is_done) = sync_channel(1);
        let is_done = Mutex::new(is_done);
        let within = limit.left(Duration::MAX);
        let closing = std::thread::Builder::new().name("scl-close".to_owned()).spawn(move || {
            let closed = no_panic(|| component.close_blocking(within).map_err(|error| Failure::of(error.inner())));
            let _nobody_waits = done.send(closed);
        });
        closing?;
        loop {
            let closed = detach(py, || is_done.lock().unwrap_or_else(PoisonError::into_inner).recv_timeout(LOOK))?;
            match closed {
                Ok(closed) => return Ok(closed?),
                Err(RecvTimeoutError::Timeout) => py.check_signals()?,
                Err(RecvTimeoutError::Disconnected) => return Ok(()),
            }
        }
    }

    /// Returns a file descriptor for event loops. It reports the calls that were polled with it or, with `all_gates`,
    /// all gates.
    fn readiness(&self, all_gates: bool) -> PyResult<Readiness> {
        match all_gates {
            true => self.shared.check_open()?,
            false => self.shared.check()?,
        }
        let component = self.component.lock().unwrap_or_else(PoisonError::into_inner);
        let component = component.as_ref().ok_or_else(|| self.shared.ended())?;
        let readiness = match all_gates {
            true => component.readiness().map_err(|error| Failure::of(&error)),
            false => component.readiness_of(&[]).map_err(|error| Failure::of(error.inner())),
        };
        Ok(Readiness { readiness: self.shared.keep(readiness?) })
    }

    #[getter]
    fn is_closed(&self) -> bool {
        self.shared.is_closed()
    }

    /// Whether it is one of the two components of a unit test.
    #[getter]
    fn is_test(&self) -> bool {
        self.is_test
    }

    fn __repr__(&self) -> String {
        format!("<component {} of {}>", self.shared.component, self.shared.system)
    }
}

impl WithGates {
    fn of(mut component: untyped::Component, plan: &scl::plan::Plan) -> Result<Self, Failure> {
        let gates = plan.gates.iter().map(|gate| component.gate(&gate.name)).collect::<Result<_, _>>();
        Ok(Self { gates: gates.map_err(|error| Failure::new("OpenError", text_with_causes(&error)))?, component })
    }
}

impl Component {
    fn new(py: Python<'_>, plan: &scl::plan::Plan, opened: WithGates, is_test: bool) -> PyResult<Self> {
        let WithGates { gates, component } = opened;
        let shared = Arc::new(Shared::new(&component, &plan.component, &plan.system));
        let gates = plan.gates.iter().zip(gates);
        let gates = gates.map(|(plan, gate)| Py::new(py, Gate::new(plan.clone(), Arc::clone(&shared), gate)));
        let gates = gates.collect::<PyResult<Vec<_>>>()?;
        Ok(Self {
            component: shared.keep(Mutex::new(Some(component))),
            shared,
            gates,
            taken_over: AtomicU64::new(0),
            is_test,
        })
    }

    /// How many changes of live parameters the program has taken over.
    fn taken_over(&self) -> u64 {
        self.taken_over.load(Ordering::Acquire)
    }

    /// Calls `call` with the component, which must be open.
    fn with<R: Send>(&self, py: Python<'_>, call: impl FnOnce(&untyped::Component) -> R + Send) -> PyResult<R> {
        self.shared.check_open()?;
        let called = detach(py, || {
            let component = self.component.lock().unwrap_or_else(PoisonError::into_inner);
            Ok::<_, Failure>(call(component.as_ref().ok_or_else(|| self.shared.ended())?))
        })?;
        Ok(called?)
    }
}

fn options(runtime_dir: Option<PathBuf>, system: Option<String>, transport: Option<&str>) -> PyResult<OpenOptions> {
    let mut options = OpenOptions::new();
    if let Some(folder) = runtime_dir {
        options = options.runtime_dir(folder);
    }
    if let Some(name) = system {
        options = options.system(name);
    }
    if let Some(text) = transport {
        let wrong = |error: TransportChoiceError| PyValueError::new_err(format!("transport={text:?}: {error}"));
        options = options.transports(text.parse().map_err(wrong)?);
    }
    Ok(options)
}

/// Sets values of parameters, by `component.parameter`.
fn with_values(options: OpenOptions, values: Option<BTreeMap<String, String>>) -> OpenOptions {
    values.into_iter().flatten().fold(options, |options, (parameter, value)| options.set(parameter, value))
}
