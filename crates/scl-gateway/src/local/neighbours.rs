//! Exchanges with the other hosts which components run where, and logs hosts that connect and disconnect.

use super::mirroring::Remote;
use crate::slot::Slot;
use crate::wire::{Announced, Neighbour, Wire};
use scl::bridge::Change;
use std::collections::HashMap;
use std::future::poll_fn;
use std::sync::Arc;
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender};

/// Handles events from the other hosts until the gateway ends.
pub(super) async fn follow(wire: Arc<Wire>, remotes: HashMap<String, UnboundedSender<Remote>>) {
    let tell = |component: &str, remote| {
        if let Some(remotes) = remotes.get(component) {
            let _the_gateway_ends = remotes.send(remote);
        }
    };
    loop {
        match poll_fn(|cx| wire.poll_neighbour(cx)).await {
            Neighbour::Started { component, host, content } => tell(&component, Remote::Started { host, content }),
            Neighbour::Stopped { component, host } => tell(&component, Remote::Stopped { host }),
            Neighbour::Connected { host } => tracing::info!("host `{host}` is connected"),
            Neighbour::Disconnected { host } => tracing::warn!("host `{host}` is not connected any more"),
            Neighbour::Mismatch { text, .. } => tracing::warn!("{text}"),
            Neighbour::Refused { text } => tracing::error!("{text}"),
        }
    }
}

/// Announces the runs of a component, one after the other. A route that still carries messages of a run holds its
/// announcement, so until then the component counts as running for other hosts.
pub(super) async fn announce(wire: Arc<Wire>, mut changes: UnboundedReceiver<Change>, mut run: Slot<Announced>) {
    while let Some(change) = changes.recv().await {
        match change {
            Change::Started { component, profile } => {
                run.clear().await;
                tracing::info!("component `{component}` has started; announcing it to the other hosts");
                run.put(wire.announce(&component, profile.to_bytes()));
            }
            Change::Stopped { component } => {
                tracing::info!("component `{component}` has stopped");
                run.clear().await;
            }
            Change::Removed => {}
        }
    }
}
