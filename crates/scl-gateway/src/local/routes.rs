//! Starting the task of each route.

use crate::pump::{Counts, Ends, Pump, Receiving, Replying, Requesting, Sending};
use crate::route::{Pattern, RouteEnd};
use crate::slot::View;
use crate::wire::{Announced, Wire};
use scl::bridge::Mirror;
use scl::transport::zeromq::ZeroMq;
use std::collections::HashMap;
use std::sync::Arc;
use tokio::sync::watch;
use tokio::task::JoinSet;

type Views<T> = HashMap<String, View<T>>;

/// Starts the routes that begin or end at this host, and returns their tasks, keys and counts. A route whose component
/// is not on the host that the route names is not started; an error is logged.
pub(super) fn start(
    transport: ZeroMq,
    wire: &Wire,
    runs: &Views<Announced>,
    mirrors: &Views<Mirror>,
    stop: &watch::Receiver<bool>,
) -> (JoinSet<()>, Vec<(String, Arc<Counts>)>) {
    let (options, transport) = (wire.options(), Arc::new(transport));
    let (mut pumps, mut counted) = (JoinSet::new(), Vec::new());
    for route in &options.routes {
        let counts = Arc::new(Counts::default());
        counted.push((route.key.clone(), Arc::clone(&counts)));
        let leaves = route.from.host == options.host;
        let (near, far) = if leaves { (&route.from, &route.to) } else { (&route.to, &route.from) };
        let Some((component, mirror)) = optional(near, runs).zip(optional(far, mirrors)) else {
            tracing::error!("route `{}` names a component that is not on the host that the route names", route.key);
            continue;
        };
        let ends = Ends { route: route.clone(), mirror, component, transport: Arc::clone(&transport), counts };
        let stop = stop.clone();
        match (route.pattern, leaves) {
            (Pattern::Messages { .. }, true) => {
                pumps.spawn(Pump::<_, Sending>::new(ends, wire.sender(route)).run(stop))
            }
            (Pattern::Messages { .. }, false) => {
                pumps.spawn(Pump::<_, Receiving>::new(ends, wire.receiver(route)).run(stop))
            }
            (Pattern::Requests, true) => pumps.spawn(Pump::<_, Requesting>::new(ends, wire.requester(route)).run(stop)),
            (Pattern::Requests, false) => pumps.spawn(Pump::<_, Replying>::new(ends, wire.replier(route)).run(stop)),
        };
    }
    (pumps, counted)
}

/// Returns the view of the component at an end: `Some(None)` if any component may connect there, `None` if the
/// component is unknown.
fn optional<T>(end: &RouteEnd, views: &Views<T>) -> Option<Option<View<T>>> {
    match &end.component {
        Some(component) => views.get(component).cloned().map(Some),
        None => Some(None),
    }
}
