//! One component of this host: announced to the other hosts while it runs.

use crate::slot::Slot;
use crate::wire::{Announced, Wire};
use scl::bridge::{Change, Profile};
use std::sync::Arc;
use tokio::sync::mpsc::UnboundedReceiver;

/// Announces the runs of a component, one after the other. As long as a route still carries what a run has sent, it holds the
/// announcement, so the component counts as running for other hosts.
pub(super) async fn announce(wire: Arc<Wire>, mut changes: UnboundedReceiver<Change>, mut run: Slot<Announced>) {
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

async fn start(wire: &Wire, component: &str, profile: &Profile, run: &mut Slot<Announced>) {
    run.clear().await;
    tracing::info!("component `{component}` has started; announcing it to the other hosts");
    run.put(wire.announce(component, profile.to_bytes()));
}
