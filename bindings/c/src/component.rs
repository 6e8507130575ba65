//! Components: opening, waiting for peers, closing.

use crate::border::{self, Wait};
use crate::error::Failure;
use crate::gate::{self, GATES, scl_gate};
use crate::options::Options;
use crate::registry::Registry;
use crate::status::*;
use crate::values::Parameters;
use scl::host;
use scl::plan::SystemPlan;
use scl::untyped::{Closer, Component, GateError, Readiness, started_as};
use scl_text::suggest::closest_name;
use std::ffi::{CString, c_char, c_void};
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// A component, opened by this process.
#[allow(non_camel_case_types)]
pub struct scl_component {
    _opaque: [u8; 0],
}

/// An open component.
pub(crate) struct Opened {
    name: &'static str,
    /// The name for C.
    c_name: CString,
    /// `None` once closed. Calls that wait hold a read lock.
    component: RwLock<Option<Component>>,
    /// Ends the calls of the component and its gates.
    closer: Closer,
    /// Names and handles of its gates.
    gates: Vec<(&'static str, usize)>,
    pub(crate) parameters: Parameters,
    /// Opened by the first `scl_fd`.
    readiness: OnceLock<Readiness>,
}

static COMPONENTS: Registry<Arc<Opened>> = Registry::new(3, "component");

/// Opens a component: registers it in the runtime folder and opens its gates. Peers connect by themselves, in whatever
/// order the programs start.
///
/// `plan_json`, of `plan_len` bytes, is the plan of the system or of one component, as `scl plan` prints it; generated
/// code contains it. `component` is the name of the component, or that of a kind: then the program is the component of
/// the kind that the environment variable SCL_COMPONENT names, which `scl run` sets. `options_json` is NULL for the
/// defaults, or an object with any of these keys:
///
///     {"runtime_dir": "/run/rover", "system": "rover-2", "transport": "ipc", "signals": true,
///      "set": {"controller.period": "10ms"}}
///
/// The first three replace the environment variables SCL_RUNTIME_DIR, SCL_SYSTEM and SCL_TRANSPORT. `set` has values of
/// parameters, as texts like in the topology file; they count more than those of SCL_SET. The transport is
/// `ipc`, `tcp` or `shm`, or a list with others for single connections, like `ipc,camera.frames=shm`; `shm` needs a
/// library that was built with the feature `shm`. The first component also starts the log (SCL_LOG) and applies the
/// real-time settings (SCL_SCHED, SCL_CPU) to the calling thread. Unless `signals` is false, SIGTERM and SIGINT no
/// longer end the process but request a stop: see scl_stop_requested.
///
/// On success, `*opened` is the new component, to be closed with scl_close; otherwise it is NULL.
///
/// Errors: SCL_PLAN, SCL_NAME (the plan has no such component or kind), SCL_TAKEN, SCL_FOLDER, SCL_ENVIRONMENT (also if
/// SCL_COMPONENT names none of the kind, or a parameter has no value or a wrong one), SCL_SYSTEM, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_open(
    plan_json: *const c_char,
    plan_len: usize,
    component: *const c_char,
    options_json: *const c_char,
    opened: *mut *mut scl_component,
) -> scl_status {
    let open = || {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let (plan, name) = unsafe {
            (border::bytes(plan_json.cast::<c_void>(), plan_len, "plan_json")?, border::text(component, "component")?)
        };
        // SAFETY: guaranteed by the caller.
        Ok(open(plan, name, &unsafe { options(options_json) }?)? as *mut scl_component)
    };
    // SAFETY: guaranteed by the caller; NULL is refused.
    border::status(|| unsafe { border::give(opened, "opened", open) })
}

/// Opens a component for a unit test, together with its counterpart, which has the opposite end of each gate under the
/// same name: where the component receives, its counterpart sends. Both are connected within this process, without
/// sockets or files, so any number of tests may run at the same time. Signals and the environment have no effect.
///
/// The first three arguments are those of scl_open; of a kind, its first component is opened. On success, `*opened` and
/// `*peer` are the new components, each to be closed with scl_close; otherwise they are NULL.
///
/// Errors: SCL_PLAN, SCL_NAME (the plan has no such component or kind), SCL_ENVIRONMENT (a parameter has no value),
/// SCL_SYSTEM, SCL_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_open_test(
    plan_json: *const c_char,
    plan_len: usize,
    component: *const c_char,
    opened: *mut *mut scl_component,
    peer: *mut *mut scl_component,
) -> scl_status {
    // SAFETY: guaranteed by the caller.
    unsafe { scl_open_test_with(plan_json, plan_len, component, std::ptr::null(), opened, peer) }
}

/// scl_open_test with options, of which only `set` has an effect: `{"set": {"controller.period": "10ms"}}`. They may be
/// NULL.
///
/// Errors: also SCL_ENVIRONMENT if a parameter has a wrong value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_open_test_with(
    plan_json: *const c_char,
    plan_len: usize,
    component: *const c_char,
    options_json: *const c_char,
    opened: *mut *mut scl_component,
    peer: *mut *mut scl_component,
) -> scl_status {
    border::status(|| {
        if std::ptr::eq(opened, peer) && !opened.is_null() {
            return Err(Failure::argument("`opened` and `peer` are the same pointer"));
        }
        // SAFETY: guaranteed by the caller; NULL is refused, and the pointers differ.
        let (opened, peer) = unsafe { (border::result(opened, "opened")?, border::result(peer, "peer")?) };
        (*opened, *peer) = (std::ptr::null_mut(), std::ptr::null_mut());
        // SAFETY: guaranteed by the caller; NULL is refused.
        let (plan, name) = unsafe {
            (border::bytes(plan_json.cast::<c_void>(), plan_len, "plan_json")?, border::text(component, "component")?)
        };
        // SAFETY: guaranteed by the caller.
        let handles = open_test(plan, name, &unsafe { options(options_json) }?)?;
        [*opened, *peer] = handles.map(|handle| handle as *mut scl_component);
        Ok(())
    })
}

/// Waits until all required peers are connected. A timeout of 0 only looks, a negative one waits without limit.
///
/// Errors: SCL_TIMEOUT (the text names the missing peers and says why), SCL_STOPPED, SCL_CLOSED, SCL_HANDLE.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_ready(component: *mut scl_component, timeout_ns: i64) -> scl_status {
    border::status(|| {
        let opened = find(component)?;
        let limit = Wait::of(timeout_ns).limit();
        opened.with(|component| component.ready_blocking(limit).map_err(|error| Failure::of_any(error.inner())))
    })
}

/// Waits until every peer that is running has taken all messages, then closes the component and all its gates, whose
/// handles become invalid. A timeout of 0 hands over what is possible at once, a negative one waits without limit.
/// After a stop request it waits for connected peers only, and at most 500 ms.
///
/// The component is always closed and freed, whatever the result, except for SCL_HANDLE, SCL_ARGUMENT and SCL_FORKED.
/// Calls that wait in other threads end with SCL_CLOSED. Messages that were received stay valid.
///
/// Errors: SCL_NOT_FLUSHED (the text says how many messages which peers have not taken).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_close(component: *mut scl_component, timeout_ns: i64) -> scl_status {
    border::status(|| close(component as usize, Wait::of(timeout_ns)))
}

/// Returns the name of the component in the topology file, or NULL for a handle that is not valid. For a kind, it says
/// which component of the kind was opened.
///
/// The text belongs to the component and is valid until scl_close.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_component_name(component: *mut scl_component) -> *const c_char {
    let name = border::value(|| Ok(find(component)?.c_name.as_ptr()));
    name.unwrap_or(std::ptr::null())
}

/// Returns a gate of the component, or NULL if it has none with this name; scl_error then names the nearest one.
///
/// The gate belongs to the component and is valid until scl_close. The same name gives the same gate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_gate_by_name(component: *mut scl_component, name: *const c_char) -> *mut scl_gate {
    let gate = border::value(|| {
        let opened = find(component)?;
        // SAFETY: guaranteed by the caller; NULL is refused.
        let name = unsafe { border::text(name, "name") }?;
        match opened.gates.iter().find(|(known, _)| *known == name) {
            Some((_, gate)) => Ok(*gate as *mut scl_gate),
            None => Err(opened.unknown_gate(name)),
        }
    });
    gate.unwrap_or(std::ptr::null_mut())
}

/// # Safety
/// `json` is NULL or a text.
unsafe fn options(json: *const c_char) -> Result<Options, Failure> {
    match json.is_null() {
        true => Ok(Options::default()),
        // SAFETY: guaranteed by the caller.
        false => Options::read(unsafe { border::text(json, "options_json") }?),
    }
}

fn open(plan: &[u8], name: &str, options: &Options) -> Result<usize, Failure> {
    let plan = read(plan)?;
    let plan = started_as(&plan, name)?;
    set_up(options)?;
    insert(Component::open_blocking_with(plan, options.for_opening())?)
}

fn open_test(plan: &[u8], name: &str, options: &Options) -> Result<[usize; 2], Failure> {
    let plan = read(plan)?;
    let plan = plan.component_or_first(name).map_err(|error| Failure::of(SCL_NAME, &error))?;
    host::start_log()?;
    let (component, peer) = Component::test_blocking_with(plan, options.for_opening())?;
    let component = insert(component)?;
    match insert(peer) {
        Ok(peer) => Ok([component, peer]),
        Err(failure) => {
            close(component, Wait::No)?;
            Err(failure)
        }
    }
}

fn read(plan: &[u8]) -> Result<SystemPlan, Failure> {
    let utf8 = |error| Failure::new(SCL_PLAN, format!("the plan is not UTF-8: {error}"));
    let text = std::str::from_utf8(plan).map_err(utf8)?;
    SystemPlan::from_json(text).map_err(|error| Failure::of(SCL_PLAN, &error))
}

/// Registers a component and its gates, and returns the handle of the component.
fn insert(mut component: Component) -> Result<usize, Failure> {
    let spec = component.spec();
    let (name, specs, mut gates) = (spec.name, spec.gates, Vec::new());
    for gate in specs {
        let inserted = component.gate(gate.name).map_err(Failure::from).and_then(|gate| gate::insert(name, gate));
        match inserted {
            Ok(handle) => gates.push((gate.name, handle)),
            Err(failure) => {
                remove(&gates);
                return Err(failure);
            }
        }
    }
    let parameters = Parameters::of(&component);
    let (closer, component) = (component.closer(), RwLock::new(Some(component)));
    // No name contains a NUL: sockets are named after it.
    let c_name = CString::new(name).unwrap_or_default();
    let readiness = OnceLock::new();
    COMPONENTS.insert(Arc::new(Opened { name, c_name, component, closer, gates, parameters, readiness }))
}

/// Does what `#[scl::main]` does for a Rust program before its first component is opened.
fn set_up(options: &Options) -> Result<(), Failure> {
    host::start_log()?;
    host::notify_service_manager();
    if options.signals() {
        host::watch_signals().map_err(|error| Failure::of_any(error.inner()))?;
    }
    Ok(host::apply_real_time()?)
}

fn close(handle: usize, wait: Wait) -> Result<(), Failure> {
    let opened = COMPONENTS.remove(handle)?;
    opened.closer.end_calls();
    // Drop the gates before `close_blocking` flushes what they have sent.
    remove(&opened.gates);
    let component = opened.component.write().unwrap_or_else(PoisonError::into_inner).take();
    match component {
        Some(component) => component.close_blocking(wait.limit()).map_err(|error| Failure::of_any(error.inner())),
        None => Ok(()),
    }
}

/// Invalidates the handles of a component's gates.
fn remove(gates: &[(&str, usize)]) {
    // Ignore the results: these are the component's own gates, and each is removed only once.
    gates.iter().for_each(|(_, gate)| drop(GATES.remove(*gate)));
}

/// Returns the component of a handle.
pub(crate) fn find(component: *mut scl_component) -> Result<Arc<Opened>, Failure> {
    COMPONENTS.get(component as usize)
}

impl Opened {
    /// Returns true if a handle is that of one of its gates.
    pub(crate) fn owns(&self, gate: *mut scl_gate) -> bool {
        self.gates.iter().any(|(_, handle)| *handle == gate as usize)
    }

    /// Makes a call to the component, which stays open until the call ends.
    pub(crate) fn with<T>(&self, call: impl FnOnce(&Component) -> Result<T, Failure>) -> Result<T, Failure> {
        let component = self.component.read().unwrap_or_else(PoisonError::into_inner);
        let closed = Failure::usual(SCL_CLOSED, c"the component was closed by another thread");
        call(component.as_ref().ok_or(closed)?)
    }

    /// Returns the descriptor for event loops, which the first call opens.
    pub(crate) fn readiness(&self) -> Result<&Readiness, Failure> {
        if let Some(readiness) = self.readiness.get() {
            return Ok(readiness);
        }
        let opened = self.with(|component| component.readiness().map_err(|error| Failure::of(SCL_SYSTEM, &error)))?;
        Ok(self.readiness.get_or_init(|| opened))
    }

    fn unknown_gate(&self, name: &str) -> Failure {
        let names = || self.gates.iter().map(|(name, _)| *name);
        let nearest = closest_name(name, names()).map(str::to_owned);
        let (component, known) = (self.name.to_owned(), names().map(str::to_owned).collect());
        GateError::Unknown { component, gate: name.to_owned(), nearest, known }.into()
    }
}
