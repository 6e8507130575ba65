//! What the other hosts run, passed on to the tasks that show it here, and the log of hosts that come and go.

use super::mirroring::Remote;
use crate::wire::{Neighbour, Wire};
use std::collections::HashMap;
use std::future::poll_fn;
use std::sync::Arc;
use tokio::sync::mpsc::UnboundedSender;

/// Follows the other hosts until the gateway ends.
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
