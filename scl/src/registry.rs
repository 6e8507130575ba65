//! Registries: which process runs a component, and what is known about its neighbours. How messages move is up to the
//! transport.
//!
//! Between programs, the registry is the runtime folder ([`runtime_dir`](crate::runtime_dir)). A
//! [`transport`](crate::OpenOptions::transport) of your own comes without a registry, unless you bring one with
//! [`OpenOptions::registry`](crate::OpenOptions::registry): then a component can be opened only once, errors say which
//! process runs it and why a peer is missing, and closing waits for peers that are running but not connected yet.

use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::transport::PeerCheck;
use std::error::Error;
use std::pin::Pin;
use std::sync::Arc;

/// A registry, in which the components of a system take their names and find each other.
///
/// ```
/// use scl::OpenOptions;
/// use scl::registry::{Neighbour, Registered, Registry, RegistryError};
/// use scl::spec::ComponentSpec;
/// use scl::transport::memory::Memory;
/// use std::collections::HashSet;
/// use std::sync::{Arc, Mutex};
///
/// /// The components that run within this process.
/// #[derive(Clone, Default)]
/// struct InProcess(Arc<Mutex<HashSet<&'static str>>>);
///
/// struct Entry(InProcess, &'static str);
///
/// impl Registry for InProcess {
///     fn register(&self, component: &'static ComponentSpec) -> Result<Box<dyn Registered>, RegistryError> {
///         if !self.0.lock().unwrap().insert(component.name) {
///             return Err(RegistryError::Taken { component: component.name, by: "this process".to_owned() });
///         }
///         Ok(Box::new(Entry(self.clone(), component.name)))
///     }
/// }
///
/// impl Registered for Entry {
///     fn neighbour(&self, component: &str) -> Option<Neighbour> {
///         self.0.0.lock().unwrap().contains(component).then_some(Neighbour::ThisProcess)
///     }
/// }
///
/// impl Drop for Entry {
///     fn drop(&mut self) {
///         self.0.0.lock().unwrap().remove(self.1);
///     }
/// }
///
/// let options = OpenOptions::new().transport(Memory::new()).registry(InProcess::default());
/// ```
pub trait Registry: Send + Sync + 'static {
    /// Takes the component's name and announces it; its plan is in `component`. Called before its gates are opened,
    /// inside a tokio runtime of any kind.
    ///
    /// # Errors
    /// [`RegistryError`]: the name is taken, or cannot be taken.
    fn register(&self, component: &'static ComponentSpec) -> Result<Box<dyn Registered>, RegistryError>;
}

/// A component that is registered. Dropped after everything that the component has opened; then its name is free.
pub trait Registered: Send + Sync {
    /// Returns which process runs a component of the system, or `None` if none does.
    fn neighbour(&self, component: &str) -> Option<Neighbour>;

    /// Returns the check that a connecting end of `gate` calls before it connects to a peer. By default there is none,
    /// so every peer is accepted.
    fn peer_check(&self, gate: &'static GateSpec, connection: &'static ConnectionSpec) -> Option<PeerCheck> {
        let _accepts_every_peer = (gate, connection);
        None
    }

    /// Returns the check that a sending end calls before it warns that it drops messages for `peer`, which was
    /// connected before. By default there is none, so it always warns.
    fn end_check(&self, peer: &'static str) -> Option<EndCheck> {
        let _misses_every_peer = peer;
        None
    }

    /// Explains why a peer is not connected, in words that follow the peer's name: `is not running`.
    fn explain_missing(&self, gate: &GateSpec, connection: &ConnectionSpec) -> String {
        let _of_any_gate = gate;
        let state =
            if self.neighbour(connection.peer_component).is_some() { "is not connected" } else { "is not running" };
        state.to_owned()
    }

    /// Keeps the registration while the component is open; run as a task of the component. The default does nothing.
    fn keep(&self) -> Pin<Box<dyn Future<Output = ()> + Send>> {
        Box::pin(std::future::ready(()))
    }
}

/// Returns true if a peer's program has closed it in order, for example because its task is done: then dropped messages
/// cause no warning.
pub type EndCheck = Arc<dyn Fn() -> bool + Send + Sync>;

/// Which process runs a component.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Neighbour {
    /// The calling process. Blocking calls do not wait for such a component, because it may be run by the thread that
    /// waits.
    ThisProcess,
    /// Another process.
    OtherProcess,
}

/// A component could not be registered.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum RegistryError {
    /// The component is already running.
    #[error("component `{component}` is already running as {by}; stop it first")]
    Taken {
        /// The component.
        component: &'static str,
        /// The process that runs it: `process 4711`.
        by: String,
    },
    /// The registry failed.
    #[error("component `{component}` cannot be registered")]
    Failed {
        /// The component.
        component: &'static str,
        /// Why.
        source: Box<dyn Error + Send + Sync>,
    },
}

/// The registration of a component on the user's own transport without a registry: nothing is known about its
/// neighbours.
pub(crate) struct Unregistered;

impl Registered for Unregistered {
    fn neighbour(&self, _component: &str) -> Option<Neighbour> {
        None
    }

    fn explain_missing(&self, _gate: &GateSpec, _link: &ConnectionSpec) -> String {
        "is not connected".to_owned()
    }
}
