//! Starting the task of each route.

use super::GatewayOptions;
use crate::pump::{Carry, Counts, Pump, Receiving, Replying, Requesting, Sending};
use crate::route::{Pattern, Route, RouteEnd};
use crate::slot::View;
use crate::wire::{Announced, Wire};
use scl::bridge::Mirror;
use scl::transport::zeromq::ZeroMq;
use std::collections::HashMap;
use std::sync::Arc;
use tokio::sync::watch;
use tokio::task::JoinSet;

type Views<T> = HashMap<String, View<T>>;

/// Starts the routes that begin or end at this host, and returns their tasks, keys and counts. A route of a component
/// that is on no host cannot exist, and is left out.
pub(super) fn start(
    options: &GatewayOptions,
    wire: &Wire,
    runs: &Views<Announced>,
    mirrors: &Views<Mirror>,
    stop: &watch::Receiver<bool>,
) -> (JoinSet<()>, Vec<(String, Arc<Counts>)>) {
    let transport = Arc::new(ZeroMq::new(options.dir.clone(), options.kind));
    let (mut pumps, mut counted) = (JoinSet::new(), Vec::new());
    for route in &options.routes {
        let counts = Arc::new(Counts::default());
        counted.push((route.key.clone(), Arc::clone(&counts)));
        let leaves = route.from.host == options.host;
        let (near, far) = if leaves { (&route.from, &route.to) } else { (&route.to, &route.from) };
        let views = optional(near, runs).zip(optional(far, mirrors));
        let start = views.map(|(component, mirror)| Start {
            wire,
            component,
            mirror,
            transport: &transport,
            counts,
            route,
            stop,
        });
        let started = start.map(|start| match (route.pattern, leaves) {
            (Pattern::Messages { .. }, true) => start.pump::<_, Sending>(&mut pumps, Wire::sender),
            (Pattern::Messages { .. }, false) => start.pump::<_, Receiving>(&mut pumps, Wire::receiver),
            (Pattern::Requests, true) => start.pump::<_, Requesting>(&mut pumps, Wire::requester),
            (Pattern::Requests, false) => start.pump::<_, Replying>(&mut pumps, Wire::replier),
        });
        if started.is_none() {
            tracing::error!("route `{}` names a component that is not on the host it should be on", route.key);
        }
    }
    (pumps, counted)
}

struct Start<'a> {
    wire: &'a Wire,
    component: Option<View<Announced>>,
    mirror: Option<View<Mirror>>,
    transport: &'a Arc<ZeroMq>,
    counts: Arc<Counts>,
    route: &'a Route,
    stop: &'a watch::Receiver<bool>,
}

impl Start<'_> {
    /// Starts a pump with the end of the wire that `open` gives it.
    fn pump<W, S>(self, pumps: &mut JoinSet<()>, open: fn(&Wire, &Route) -> W)
    where
        W: Send + 'static,
        S: Default + Send + 'static,
        Pump<W, S>: Carry,
    {
        let (route, transport) = (self.route.clone(), Arc::clone(self.transport));
        let wire = open(self.wire, &route);
        let pump = Pump::<W, S>::new(route, wire, self.mirror, self.component, transport, self.counts);
        pumps.spawn(pump.run(self.stop.clone()));
    }
}

/// `Some(None)` for an end at which any component may connect.
fn optional<T>(end: &RouteEnd, views: &Views<T>) -> Option<Option<View<T>>> {
    match &end.component {
        Some(component) => views.get(component).cloned().map(Some),
        None => Some(None),
    }
}
