//! A component of another host, present in this host's runtime folder.

use super::{Profile, ProfileError};
use crate::error::OpenError;
use crate::intern::intern;
use crate::registration::Registration;
use crate::registry::Registered;
use crate::runtime_dir::{Announcement, ComponentProcess, RuntimeDirError, SystemDir};
use crate::spec::{ComponentSpec, ConnectionSpec, GateSpec};
use crate::transport::{Endpoint, Window};

/// Stands in for a component that runs on another host: components of this host see its lock, its announcement and its
/// messages as if it ran here. Drop it after all ends that were opened for it.
#[derive(Debug)]
pub struct Mirror {
    spec: &'static ComponentSpec,
    registration: Registration,
}

/// A component of another host cannot be shown here.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MirrorError {
    /// Its announcement cannot be used.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// Its plan contradicts itself.
    #[error(transparent)]
    Plan(#[from] OpenError),
    /// Its announcement or its plan names another component.
    #[error("host `{host}` announces component `{expected}` with the plan of `{found}`")]
    WrongPlan {
        /// The host.
        host: String,
        /// The component.
        expected: String,
        /// The component of the plan.
        found: String,
    },
    /// It runs on this host as well.
    #[error(
        "component `{component}` runs on host `{host}`, and on this host as well ({holder})\n\
         help: stop one of the two, or correct `hosts` in the launch file"
    )]
    RunsHere {
        /// The component.
        component: String,
        /// The other host.
        host: String,
        /// The process that runs it here.
        holder: ComponentProcess,
    },
    /// The runtime folder cannot be used.
    #[error(transparent)]
    RuntimeDir(RuntimeDirError),
    /// Its program was built without this gate or connection.
    #[error("component `{component}` was built without {what}; build all programs from the same topology")]
    NoConnection {
        /// The component.
        component: String,
        /// What is missing: a gate, or its connection to a peer.
        what: String,
    },
}

impl Mirror {
    /// Registers a stand-in for `component`, which runs on `host`.
    ///
    /// # Errors
    /// [`MirrorError`]; nothing is left behind.
    pub fn open(dir: &SystemDir, component: &str, host: &str, profile: &Profile) -> Result<Self, MirrorError> {
        let plan = profile.plan()?;
        if plan.component != component || profile.announcement().component != component {
            let (host, expected) = (host.to_owned(), component.to_owned());
            return Err(MirrorError::WrongPlan { host, expected, found: plan.component });
        }
        let spec = intern(&plan)?;
        // The process, its program and its start are the local ones, which tools can inspect. Endpoints and the rest
        // are as announced on the other host.
        let own = Announcement::of_this_process(component);
        let announcement = Announcement {
            pid: own.pid,
            started: own.started,
            program: own.program,
            host: Some(host.to_owned()),
            ..profile.announcement().clone()
        };
        let registration = Registration::announcing(spec, dir.clone(), announcement, None);
        let registration = registration.map_err(|error| match error {
            RuntimeDirError::AlreadyRunning { component, holder, .. } => {
                MirrorError::RunsHere { component, host: host.to_owned(), holder }
            }
            error => MirrorError::RuntimeDir(error),
        })?;
        Ok(Self { spec, registration })
    }

    /// Creates the files of the component again if they were removed, and lets its ends listen again. One watch of the
    /// folder serves all mirrors of a process, see [`Change::Removed`](super::Change::Removed): the number of inotify
    /// instances per user is limited.
    ///
    /// # Errors
    /// [`MirrorError::RuntimeDir`], also if another process runs the component by now.
    pub fn restore(&self) -> Result<(), MirrorError> {
        self.registration.restore_if_removed().map(drop).map_err(MirrorError::RuntimeDir)
    }

    /// Returns the endpoint at which this component's `sub` gate connects to a publisher. The caller acknowledges the
    /// messages that this end receives; the publisher may have up to `window` unacknowledged.
    ///
    /// # Errors
    /// [`MirrorError::NoConnection`].
    pub fn subscribing(&self, gate: &str, peer: (&str, &str), window: Window) -> Result<Endpoint, MirrorError> {
        let (gate, connection) = self.connection(gate, peer)?;
        let check = self.registration.peer_check(gate, connection);
        Ok(Endpoint {
            check,
            deferred: Some(window),
            ..Endpoint::accepting(connection.endpoint, gate.options.max_size)
        })
    }

    /// Returns the endpoint at which this component's `pub` gate listens for a subscriber.
    ///
    /// # Errors
    /// [`MirrorError::NoConnection`].
    pub fn publishing(&self, gate: &str, peer: (&str, &str)) -> Result<Endpoint, MirrorError> {
        let (gate, connection) = self.connection(gate, peer)?;
        let lossless = gate.options.waits_for(connection.when_full);
        Ok(Endpoint {
            lossless,
            latched: gate.options.latched,
            ..Endpoint::accepting(connection.endpoint, gate.options.max_size)
        })
    }

    /// Returns the endpoint at which this component's `pull` gate listens for pushers. The caller acknowledges the
    /// messages that this end receives; each pusher may have up to `window` unacknowledged.
    ///
    /// # Errors
    /// [`MirrorError::NoConnection`].
    pub fn pulling(&self, gate: &str, window: Window) -> Result<Endpoint, MirrorError> {
        let gate = self.gate(gate)?;
        Ok(Endpoint { deferred: Some(window), ..Endpoint::accepting(gate.endpoint, gate.options.max_size) })
    }

    /// Returns the endpoint at which this component's `rep` gate listens for requesters.
    ///
    /// # Errors
    /// [`MirrorError::NoConnection`].
    pub fn replying(&self, gate: &str) -> Result<Endpoint, MirrorError> {
        let gate = self.gate(gate)?;
        Ok(Endpoint::accepting(gate.endpoint, gate.options.max_size))
    }

    fn gate(&self, name: &str) -> Result<&'static GateSpec, MirrorError> {
        let gate = self.spec.gates.iter().find(|gate| gate.name == name);
        gate.ok_or_else(|| self.missing(format!("gate `{name}`")))
    }

    fn connection(
        &self,
        gate: &str,
        peer: (&str, &str),
    ) -> Result<(&'static GateSpec, &'static ConnectionSpec), MirrorError> {
        let gate = self.gate(gate)?;
        let connection =
            gate.connections.iter().find(|connection| (connection.peer_component, connection.peer_gate) == peer);
        let missing = || self.missing(format!("a connection of `{}` to `{}.{}`", gate.name, peer.0, peer.1));
        connection.map(|connection| (gate, connection)).ok_or_else(missing)
    }

    fn missing(&self, what: String) -> MirrorError {
        MirrorError::NoConnection { component: self.spec.name.to_owned(), what }
    }
}
