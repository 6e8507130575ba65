//! Starting the task of each route.

use super::GatewayOptions;
use crate::pump::{Counts, Receiving, Replying, Requesting, Sending};
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

/// Starts the routes that begin or end at this host, and returns their tasks, keys and counts. A route of a component that
/// is on no host cannot exist, and is left out.
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
        let start = Start { wire, runs, mirrors, transport: &transport, counts, route, stop };
        let leaves = route.from.host == options.host;
        let started = match (route.pattern, leaves) {
            (Pattern::Messages { .. }, true) => start.sending(&mut pumps),
            (Pattern::Messages { .. }, false) => start.receiving(&mut pumps),
            (Pattern::Requests, true) => start.requesting(&mut pumps),
            (Pattern::Requests, false) => start.replying(&mut pumps),
        };
        if started.is_none() {
            tracing::error!("route `{}` names a component that is not on the host it should be on", route.key);
        }
    }
    (pumps, counted)
}

struct Start<'a> {
    wire: &'a Wire,
    runs: &'a Views<Announced>,
    mirrors: &'a Views<Mirror>,
    transport: &'a Arc<ZeroMq>,
    counts: Arc<Counts>,
    route: &'a Route,
    stop: &'a watch::Receiver<bool>,
}

impl Start<'_> {
    fn sending(self, pumps: &mut JoinSet<()>) -> Option<()> {
        let publisher = optional(&self.route.from, self.runs)?;
        let mirror = of(&self.route.to, self.mirrors)?;
        let (route, transport) = (self.route.clone(), Arc::clone(self.transport));
        let (wire, counts, state) = (self.wire.sender(&route), self.counts, Default::default());
        pumps.spawn(Sending { route, wire, mirror, publisher, transport, counts, state }.run(self.stop.clone()));
        Some(())
    }

    fn receiving(self, pumps: &mut JoinSet<()>) -> Option<()> {
        let mirror = optional(&self.route.from, self.mirrors)?;
        let component = of(&self.route.to, self.runs)?;
        let (route, transport) = (self.route.clone(), Arc::clone(self.transport));
        let (wire, counts, state) = (self.wire.receiver(&route), self.counts, Default::default());
        pumps.spawn(Receiving { route, wire, mirror, component, transport, counts, state }.run(self.stop.clone()));
        Some(())
    }

    fn requesting(self, pumps: &mut JoinSet<()>) -> Option<()> {
        let mirror = of(&self.route.to, self.mirrors)?;
        let (route, transport) = (self.route.clone(), Arc::clone(self.transport));
        let (wire, counts, state) = (self.wire.requester(&route), self.counts, Default::default());
        pumps.spawn(Requesting { route, wire, mirror, transport, counts, state }.run(self.stop.clone()));
        Some(())
    }

    fn replying(self, pumps: &mut JoinSet<()>) -> Option<()> {
        let component = of(&self.route.to, self.runs)?;
        let (route, transport) = (self.route.clone(), Arc::clone(self.transport));
        let (wire, counts, state) = (self.wire.replier(&route), self.counts, Default::default());
        pumps.spawn(Replying { route, wire, component, transport, counts, state }.run(self.stop.clone()));
        Some(())
    }
}

fn of<T>(end: &RouteEnd, views: &Views<T>) -> Option<View<T>> {
    views.get(end.component.as_ref()?).cloned()
}

/// `Some(None)` for an end that is no component in particular.
fn optional<T>(end: &RouteEnd, views: &Views<T>) -> Option<Option<View<T>>> {
    match &end.component {
        Some(_) => of(end, views).map(Some),
        None => Some(None),
    }
}
