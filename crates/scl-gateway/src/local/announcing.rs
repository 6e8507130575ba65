//! One component of this host: announced to the other hosts while it runs.

use super::slot::Slot;
use crate::wire::{Announced, Wire};
use scl::bridge::{Change, Profile};
use std::sync::Arc;
use tokio::sync::mpsc::UnboundedReceiver;

/// A run of a component: as long as a route still carries what it has sent, it counts as running for other hosts.
#[derive(Debug)]
pub(crate) struct Run {
    _announced: Announced,
}

/// Announces the runs of a component, one after the other.
pub(crate) async fn announce(wire: Arc<Wire>, mut changes: UnboundedReceiver<Change>, mut run: Slot<Run>) {
    while let Some(change) = changes.recv().await {
        match change {
            Change::Started { component, profile } => start(&wire, &component, &profile, &mut run).await,
            Change::Stopped { component } => {
                tracing::info!("component `{component}` has stopped");
                run.clear().await;
            }
            Change::Removed => {}
        }
    }
}

async fn start(wire: &Wire, component: &str, profile: &Profile, run: &mut Slot<Run>) {
    run.clear().await;
    tracing::info!("component `{component}` has started; announcing it to the other hosts");
    run.put(Run { _announced: wire.announce(component, profile.to_bytes()) });
}
