//! Components without generated code: opened at run time from a [`Plan`], with gates by name and bytes as messages.
//!
//! For programs that learn only at run time which component they are: tools, recorders, gateways, bindings for other
//! languages. Everything else uses [`topology!`](crate::topology), which checks names, kinds and types at compile time.
//!
//! An untyped component keeps every promise of a typed one, because it consists of the same gates: it takes the same
//! lock, announces itself, and compares contracts and messages with its peers, which may be typed or not. Only encoding
//! and decoding are left to the program: [`GatePlan::payload`] and [`GatePlan::codec`] say what the bytes are.
//!
//! `scl plan topology.yaml` prints the plans of a system.
//!
//! # Example
//!
//! ```
//! use scl::plan::SystemPlan;
//! use scl::untyped::Component;
//! # #[tokio::main(flavor = "current_thread")]
//! # async fn main() -> scl::Result<()> {
//! # let options = || scl::OpenOptions::new().transport(MEMORY.clone());
//! # static MEMORY: std::sync::LazyLock<scl::transport::memory::Memory> = std::sync::LazyLock::new(Default::default);
//!
//! // Written by `scl plan rover.yaml > rover.json`.
//! let system = SystemPlan::from_json(include_str!("../doc/rover.json"))?;
//!
//! // `Component::open(plan)` outside of tests: it uses the runtime folder.
//! let mut sensor = Component::open_with(system.component("sensor")?, options()).await?;
//! let mut recorder = Component::open_with(system.component("recorder")?, options()).await?;
//!
//! let (mut sends, mut receives) = (sensor.pusher("log")?, recorder.puller("log")?);
//! sends.send(&"any bytes".into()).await?;
//! assert_eq!(receives.recv().await?, "any bytes");
//!
//! let error = sensor.publisher("measurement").unwrap_err();
//! assert_eq!(error.to_string(), "component `sensor` has no gate `measurement`; did you mean `measurements`?");
//! # Ok(())
//! # }
//! ```

mod closer;
#[cfg(feature = "memory")]
mod counterpart;
mod driver;
mod error;
mod gate;
mod parameters;
mod readiness;
mod started_as;
mod wait;

pub use closer::Closer;
pub use driver::Driver;
pub use error::{GateError, WaitError};
pub use gate::Gate;
pub use readiness::Readiness;
pub use started_as::started_as;

use crate::component::{Opener, only_failures, wait_for_peers};
use crate::error::{GateName, NotFlushed, NotReady, OpenError, SetError};
use crate::gate::{Pub, Pull, Push, Rep, Req, Sub, Watch};
use crate::intern::intern;
use crate::log;
use crate::options::OpenOptions;
#[cfg(doc)]
use crate::plan::GatePlan;
use crate::plan::Plan;
use crate::spec::{ComponentSpec, GateKind};
use crate::state::{ComponentHandle, Flush, OwnedRuntime};
use crate::stop;
use crate::values::index_of;
use bytes::Bytes;
use scl_plan::ParameterValue;
use std::io;
use std::sync::Arc;
use std::time::Duration;
use tokio::runtime::Handle;

/// A component whose gates are found by name.
///
/// Each gate is taken out of the component once, and then belongs to the caller, who may move it to another task or
/// thread. The component stays open, under its lock, until the component and all of its gates have been dropped. A gate
/// that is dropped hands over what its connected peers have not taken yet, as a field of a typed component does.
pub struct Component {
    spec: &'static ComponentSpec,
    /// In the order of `spec.gates`; `None` once taken.
    gates: Vec<Option<Gate>>,
    /// The watches of all gates, including those that were taken.
    watches: Vec<Watch>,
    /// The last field: fields are dropped in order, and the gates go first.
    handle: ComponentHandle,
}

impl Component {
    /// Opens a component on the tokio runtime of the caller, whatever its flavour: registers the component, announces
    /// it and opens its gates. Peers connect by themselves, in whatever order they start.
    ///
    /// Each different plan is kept in memory until the process ends, usually some kilobytes; opening an equal plan
    /// again needs no more. All plans together may take up to 64 MiB.
    ///
    /// # Errors
    /// [`OpenError`]: another process runs this component, the runtime folder cannot be used, the plan contradicts
    /// itself, or there is no tokio runtime; the text says which.
    ///
    /// # Cancel safety
    /// It never waits.
    pub async fn open(plan: &Plan) -> Result<Self, OpenError> {
        Self::open_with(plan, OpenOptions::new()).await
    }

    /// [`open`](Self::open) with options other than the environment's.
    ///
    /// # Errors
    /// Those of `open`.
    pub async fn open_with(plan: &Plan, options: OpenOptions) -> Result<Self, OpenError> {
        let spec = intern(plan)?;
        if Handle::try_current().is_err() {
            return Err(OpenError::NoRuntime { component: spec.name });
        }
        Self::assemble(spec, &options, None)
    }

    /// Opens the component for a program without async, which uses the blocking and the non-waiting calls of its gates,
    /// from as many threads as it likes.
    ///
    /// # Errors
    /// Those of [`open`](Self::open), except that no runtime is needed: the component starts its own.
    pub fn open_blocking(plan: &Plan) -> Result<Self, OpenError> {
        Self::open_blocking_with(plan, OpenOptions::new())
    }

    /// [`open_blocking`](Self::open_blocking) with options other than the environment's.
    ///
    /// # Errors
    /// Those of `open_blocking`.
    pub fn open_blocking_with(plan: &Plan, options: OpenOptions) -> Result<Self, OpenError> {
        let spec = intern(plan)?;
        let runtime = OwnedRuntime::start(spec.name)?;
        let _entered = runtime.enter();
        Self::assemble(spec, &options, Some(Arc::clone(&runtime)))
    }

    fn assemble(
        spec: &'static ComponentSpec,
        options: &OpenOptions,
        runtime: Option<Arc<OwnedRuntime>>,
    ) -> Result<Self, OpenError> {
        let mut opener = Opener::begin(spec, options, runtime)?;
        let kinds = spec.gates.iter().map(|gate| gate.kind).enumerate();
        let gates = kinds.map(|(index, kind)| Gate::open(&mut opener, index, kind));
        let gates: Vec<Gate> = gates.collect::<Result<_, _>>()?;
        let watches = gates.iter().map(|gate| gate.any().watch()).collect();
        Ok(Self { spec, gates: gates.into_iter().map(Some).collect(), watches, handle: opener.handle() })
    }

    /// Returns what the plan says about the component and its gates.
    pub fn spec(&self) -> &ComponentSpec {
        self.spec
    }

    /// Returns the value that a parameter has now; `None` if there is no parameter of this name. Only those that are
    /// live ([`ParameterPlan::live`](crate::plan::ParameterPlan::live)) have other values later.
    pub fn parameter(&self, name: &str) -> Option<ParameterValue> {
        let index = index_of(self.spec, name).ok()?;
        self.handle.0.parameters.read(index, |value, _| value.clone())
    }

    /// Sets a live parameter, as a text like in the topology file: `10ms`.
    ///
    /// # Errors
    /// [`SetError`]: the component has no such parameter, it is not live, or it cannot have the value.
    pub fn set_parameter(&self, name: &str, value: &str) -> Result<(), SetError> {
        self.handle.0.set_parameters([(name, value)])
    }

    /// Takes a gate of whatever kind out of the component.
    ///
    /// # Errors
    /// [`GateError`]: there is no gate with this name, or it was taken before.
    pub fn gate(&mut self, name: &str) -> Result<Gate, GateError> {
        let index = self.index(name)?;
        self.gates[index].take().ok_or(GateError::Taken { gate: self.name(index) })
    }

    /// Takes a `pub` gate out of the component.
    ///
    /// # Errors
    /// [`GateError`]: there is no gate with this name, it is of another kind, or it was taken before.
    pub fn publisher(&mut self, gate: &str) -> Result<Pub<Bytes>, GateError> {
        self.take(gate, GateKind::Pub, |gate| if let Gate::Pub(gate) = gate { Some(gate) } else { None })
    }

    /// Takes a `sub` gate out of the component.
    ///
    /// # Errors
    /// Those of [`publisher`](Self::publisher).
    pub fn subscriber(&mut self, gate: &str) -> Result<Sub<Bytes>, GateError> {
        self.take(gate, GateKind::Sub, |gate| if let Gate::Sub(gate) = gate { Some(gate) } else { None })
    }

    /// Takes a `req` gate out of the component.
    ///
    /// # Errors
    /// Those of [`publisher`](Self::publisher).
    pub fn requester(&mut self, gate: &str) -> Result<Req<Bytes, Bytes>, GateError> {
        self.take(gate, GateKind::Req, |gate| if let Gate::Req(gate) = gate { Some(gate) } else { None })
    }

    /// Takes a `rep` gate out of the component.
    ///
    /// # Errors
    /// Those of [`publisher`](Self::publisher).
    pub fn replier(&mut self, gate: &str) -> Result<Rep<Bytes, Bytes>, GateError> {
        self.take(gate, GateKind::Rep, |gate| if let Gate::Rep(gate) = gate { Some(gate) } else { None })
    }

    /// Takes a `push` gate out of the component.
    ///
    /// # Errors
    /// Those of [`publisher`](Self::publisher).
    pub fn pusher(&mut self, gate: &str) -> Result<Push<Bytes>, GateError> {
        self.take(gate, GateKind::Push, |gate| if let Gate::Push(gate) = gate { Some(gate) } else { None })
    }

    /// Takes a `pull` gate out of the component.
    ///
    /// # Errors
    /// Those of [`publisher`](Self::publisher).
    pub fn puller(&mut self, gate: &str) -> Result<Pull<Bytes>, GateError> {
        self.take(gate, GateKind::Pull, |gate| if let Gate::Pull(gate) = gate { Some(gate) } else { None })
    }

    /// Waits until all required peers are connected, also those of gates that were taken. Gates that listen for any
    /// number of peers (`rep`, `pull`) have none to wait for, and neither have gates that were dropped.
    ///
    /// # Errors
    /// The peers that are missing after `timeout`, and why.
    ///
    /// # Cancel safety
    /// Cancel safe.
    pub async fn ready(&self, timeout: Duration) -> Result<(), NotReady> {
        wait_for_peers(&self.handle, &self.watches, timeout).await
    }

    /// [`ready`](Self::ready) from a plain thread.
    ///
    /// # Errors
    /// Those of `ready`; inside async code, after a stop request or after [`Closer::end_calls`],
    /// [`BlockingError`](crate::BlockingError).
    pub fn ready_blocking(&self, timeout: Duration) -> crate::Result<()> {
        let ready = self.handle.0.block_on(self.ready(timeout))?;
        // If the wait was ended early, report that instead of missing peers.
        self.handle.0.check()?;
        Ok(ready?)
    }

    /// Waits until every peer that is running has taken all messages, then closes. Peers that are running but not
    /// connected yet are waited for; one that is not running is named in a log line.
    ///
    /// Messages of gates that were taken are waited for, too. As long as such a gate exists, the component stays open
    /// and the gate works; [`closer`](Self::closer) ends its calls.
    ///
    /// Dropping the component hands over what is left, too, but waits no longer than a second, and only until it is
    /// written.
    ///
    /// # Errors
    /// The peers that have not taken everything after `timeout`, with the number of messages.
    ///
    /// # Cancel safety
    /// The component is closed in any case; what was not handed over is lost.
    pub async fn close(self, timeout: Duration) -> Result<(), NotFlushed> {
        let handle = self.handle.clone();
        drop(self);
        only_failures(handle.0.flush(Flush::Running, timeout).await)
    }

    /// [`close`](Self::close) from a plain thread.
    ///
    /// After a stop request it waits for connected peers only, because all programs are stopping, and no longer than
    /// 500 ms. Messages that they have not taken are then logged, but are no error.
    ///
    /// # Errors
    /// Those of `close`; inside async code and in a forked child, [`BlockingError`](crate::BlockingError), and the
    /// component is dropped.
    pub fn close_blocking(self, timeout: Duration) -> crate::Result<()> {
        let handle = self.handle.clone();
        handle.0.may_close()?;
        drop(self);
        if !stop::was_requested() {
            return Ok(only_failures(handle.0.flush_blocking(Flush::Running, timeout))?);
        }
        if let Err(left) = handle.0.flush_blocking(Flush::Connected, timeout.min(stop::LAST_FLUSH)) {
            log::warn(&left.to_string());
        }
        Ok(())
    }

    /// Returns a handle that ends the calls of the component and its gates, from any thread.
    pub fn closer(&self) -> Closer {
        Closer { state: Arc::downgrade(&self.handle.0) }
    }

    /// Returns a handle that waits for futures of the gates, from any plain thread.
    pub fn driver(&self) -> Driver {
        Driver { state: Arc::downgrade(&self.handle.0) }
    }

    /// Returns a file descriptor for event loops, which is readable while any receiving gate has a message or a
    /// request. See [`Readiness`].
    ///
    /// # Errors
    /// The operating system provides no file descriptor.
    pub fn readiness(&self) -> io::Result<Readiness> {
        Readiness::open(self, |_gate| true)
    }

    /// [`readiness`](Self::readiness) of some gates only, which may have been taken. Without any gate, the descriptor
    /// reports only wake-ups and stop requests: for event loops that await futures and need not be woken for messages
    /// that no future awaits.
    ///
    /// # Errors
    /// [`GateError::Unknown`] if the component has no gate with one of the names; the operating system provides no file
    /// descriptor.
    pub fn readiness_of(&self, gates: &[&str]) -> crate::Result<Readiness> {
        for gate in gates {
            self.index(gate)?;
        }
        Ok(Readiness::open(self, |gate| gates.contains(&gate))?)
    }

    fn take<G>(
        &mut self,
        name: &str,
        expected: GateKind,
        unwrap: impl FnOnce(Gate) -> Option<G>,
    ) -> Result<G, GateError> {
        let index = self.index(name)?;
        // Report a wrong kind before a taken gate: the kind is what the program has to fix.
        let (gate, found) = (self.name(index), self.spec.gates[index].kind);
        if found != expected {
            return Err(GateError::Kind { gate, found, expected });
        }
        let taken = self.gates[index].take().ok_or(GateError::Taken { gate })?;
        unwrap(taken).ok_or(GateError::Kind { gate, found, expected })
    }

    fn index(&self, name: &str) -> Result<usize, GateError> {
        let found = self.spec.gates.iter().position(|gate| gate.name == name);
        found.ok_or_else(|| GateError::unknown(self.spec, name))
    }

    fn name(&self, index: usize) -> GateName {
        GateName::new(self.spec.name, self.spec.gates[index].name)
    }
}

impl std::fmt::Debug for Component {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Component").field(&self.spec.name).finish()
    }
}
