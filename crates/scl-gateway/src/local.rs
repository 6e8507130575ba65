//! The side of the gateway that faces the components of its own host.
//!
//! The gateway announces the components of this host to the other hosts, mirrors their components in the runtime folder
//! of this host, and runs one task per route to carry messages or requests, see `pump`. It needs a tokio runtime; a
//! current-thread runtime is enough, because no task ever blocks.

mod mirroring;
mod neighbours;
mod routes;

pub use crate::pump::Counts;

use crate::slot::Slot;
use crate::wire::{Announced, Wire};
use mirroring::{Remote, mirror};
use scl::TransportKind;
use scl::bridge::{Change, Mirror, Presence};
use scl::runtime_dir::SystemDir;
use scl::transport::zeromq::ZeroMq;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Duration;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::mpsc::{self, UnboundedSender};
use tokio::sync::watch;
use tokio::task::JoinSet;

/// How long the gateway waits for messages in flight when it stops.
const STOP_LIMIT: Duration = Duration::from_millis(1500);

/// A running gateway. On SIGUSR1 it logs what each route has carried so far.
#[derive(Debug)]
pub struct Gateway {
    wire: Arc<Wire>,
    routes: Arc<Routes>,
    stop: watch::Sender<bool>,
    /// Aborted when dropped: first the routes with their ends, then the tasks that mirror and announce components.
    pumps: JoinSet<()>,
    tasks: JoinSet<()>,
}

impl Gateway {
    /// Starts the gateway. `dir` is the folder of the system on this host, and `kind` is the transport on which the
    /// ends of mirrored components listen. Must be called inside a tokio runtime. Returns at once; other hosts and
    /// components may start later.
    pub fn start(dir: SystemDir, kind: TransportKind, wire: Wire) -> Self {
        let wire = Arc::new(wire);
        let mut tasks = JoinSet::new();
        let (mut runs, mut mirrors) = (HashMap::new(), HashMap::new());
        let (mut changes, mut remotes) = (HashMap::new(), HashMap::new());
        for (component, host) in &wire.options().components {
            if *host == wire.options().host {
                let (slot, (sender, receiver)) = (Slot::<Announced>::new(), mpsc::unbounded_channel());
                runs.insert(component.clone(), slot.view());
                changes.insert(component.clone(), sender);
                tasks.spawn(neighbours::announce(Arc::clone(&wire), receiver, slot));
            } else {
                let (slot, (sender, receiver)) = (Slot::<Mirror>::new(), mpsc::unbounded_channel());
                mirrors.insert(component.clone(), slot.view());
                remotes.insert(component.clone(), sender);
                tasks.spawn(mirror(dir.clone(), component.clone(), receiver, slot));
            }
        }
        let stop = watch::Sender::new(false);
        let (pumps, routes) = routes::start(ZeroMq::new(dir.clone(), kind), &wire, &runs, &mirrors, &stop.subscribe());
        let routes = Arc::new(routes);
        tasks.spawn(log_figures_on_signal(Arc::clone(&routes)));
        let presence = Presence::new(dir, runs.into_keys());
        tasks.spawn(follow_components(presence, changes, remotes.clone()));
        tasks.spawn(neighbours::follow(Arc::clone(&wire), remotes));
        Self { wire, routes, stop, pumps, tasks }
    }

    /// Returns the key of each route and what it has carried so far, in the order of the wire's options.
    pub fn figures(&self) -> &[(String, Arc<Counts>)] {
        &self.routes
    }

    /// Stops the gateway: delivers messages in flight if that takes no longer than a second or two, logs what each
    /// route has carried, removes the components of other hosts from the runtime folder, and notifies the other hosts.
    pub async fn close(mut self) {
        self.stop.send_replace(true);
        let all_done = async { while self.pumps.join_next().await.is_some() {} };
        let _the_rest_is_aborted = tokio::time::timeout(STOP_LIMIT, all_done).await;
        self.pumps.shutdown().await;
        log_figures(&self.routes);
        self.tasks.shutdown().await;
        if let Ok(wire) = Arc::try_unwrap(self.wire) {
            wire.close().await;
        }
    }
}

/// The keys of the routes, and what they have carried.
type Routes = Vec<(String, Arc<Counts>)>;

/// Logs one line for each route whose counts are not all 0.
fn log_figures(routes: &Routes) {
    for (key, counts) in routes {
        if counts.carried() + counts.given_up() + counts.held() > 0 {
            tracing::info!("{key}: {counts}");
        }
    }
}

async fn log_figures_on_signal(routes: Arc<Routes>) {
    match signal(SignalKind::user_defined1()) {
        Ok(mut signals) => {
            while signals.recv().await.is_some() {
                log_figures(&routes);
            }
        }
        Err(error) => tracing::debug!(%error, "cannot handle SIGUSR1, so it will end the gateway"),
    }
}

type Senders<T> = HashMap<String, UnboundedSender<T>>;

async fn follow_components(mut presence: Presence, changes: Senders<Change>, remotes: Senders<Remote>) {
    loop {
        let change = presence.next().await;
        match &change {
            Change::Started { component, .. } | Change::Stopped { component } => {
                if let Some(changes) = changes.get(component) {
                    let _the_gateway_ends = changes.send(change);
                }
            }
            Change::Removed => {
                for remote in remotes.values() {
                    let _the_gateway_ends = remote.send(Remote::Removed);
                }
            }
        }
    }
}
