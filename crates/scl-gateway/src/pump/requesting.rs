//! Requests that leave this host.

use super::Counts;
use super::local_end::{Attempts, BATCH, MOST_OPEN, names};
use crate::route::Route;
use crate::slot::{Held, View};
use crate::wire::{RequesterEvent, WireRequester};
use bytes::Bytes;
use scl::bridge::Mirror;
use scl::transport::zeromq::ZeroMq;
use scl::transport::{IncomingRequest, Replier, ReplyPath, Transport};
use std::collections::BTreeMap;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::sync::watch;

/// Carries the requests of a route from components of this host to the wire, and the replies back.
pub(crate) struct Requesting {
    pub(crate) route: Route,
    pub(crate) wire: WireRequester,
    /// The far component, in whose place the local end is opened.
    pub(crate) mirror: View<Mirror>,
    pub(crate) transport: Arc<ZeroMq>,
    pub(crate) counts: Arc<Counts>,
    pub(crate) state: State,
}

#[derive(Default)]
pub(crate) struct State {
    matched: bool,
    local: Option<Local>,
    attempts: Attempts,
    /// The ways back of the requests without a reply, by the number under which they travel.
    open: BTreeMap<u64, (Bytes, Arc<dyn ReplyPath>)>,
    requests: u64,
}

/// Dropped in this order: the mirror must outlive its ends.
struct Local {
    replier: Box<dyn Replier>,
    mirror: Held<Mirror>,
}

impl Requesting {
    /// Runs until the gateway ends.
    pub(crate) async fn run(mut self, mut stop: watch::Receiver<bool>) {
        let mut mirror = self.mirror.clone();
        loop {
            let alive = tokio::select! {
                changed = mirror.changed() => changed.is_ok(),
                // Its requesters notice at once.
                _ = stop.changed() => false,
                () = poll_fn(|cx| self.poll(cx)) => false,
            };
            if !alive {
                return;
            }
        }
    }

    /// Does what can be done now. Never ready.
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            self.handle(event);
        }
        self.open_or_close(cx);
        self.carry(cx);
        self.counts.set_held(self.state.open.len() as u64);
        Poll::Pending
    }

    fn handle(&mut self, event: RequesterEvent) {
        let state = &mut self.state;
        match event {
            RequesterEvent::Matched => state.matched = true,
            RequesterEvent::Unmatched => state.matched = false,
            RequesterEvent::Reply { id, body } => {
                if let Some((envelope, path)) = state.open.remove(&id) {
                    self.counts.add_carried(1);
                    // A requester that has left needs no reply.
                    let _has_left = path.reply(&envelope, body);
                }
            }
            RequesterEvent::Refused { id } => {
                if let Some((envelope, path)) = state.open.remove(&id) {
                    self.counts.add_given_up(1);
                    path.refuse(&envelope);
                }
            }
            // As with a replier on this host that does not reply: the requester's time runs out.
            RequesterEvent::Gone { id } => {
                let unanswered = state.open.remove(&id);
                self.counts.add_given_up(u64::from(unanswered.is_some()));
            }
        }
    }

    fn open_or_close(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let mirror = self.mirror.borrow().clone().filter(|_| state.matched);
        if let Some(local) = &state.local
            && !mirror.as_ref().is_some_and(|mirror| mirror.is_same(&local.mirror))
        {
            // Requesters notice at once that their requests are lost.
            state.local = None;
            self.counts.add_given_up(state.open.len() as u64);
            state.open.clear();
        }
        if let (None, Some(mirror)) = (&state.local, mirror) {
            let (route, transport) = (&self.route, &self.transport);
            let open = || Ok(transport.reply(&mirror.replying(names(&route.to).1)?)?);
            let replier = state.attempts.open(cx, route, open);
            state.local = replier.map(|replier| Local { replier, mirror });
        }
    }

    fn carry(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let Some(local) = &mut state.local else { return };
        for _ in 0..BATCH {
            let Poll::Ready(request) = local.replier.poll_request(cx) else { return };
            let IncomingRequest { body, envelope, path } = request;
            state.requests += 1;
            state.open.insert(state.requests, (envelope, path));
            self.wire.request(state.requests, body);
            if state.open.len() > MOST_OPEN && state.open.pop_first().is_some() {
                self.counts.add_given_up(1);
            }
        }
        cx.waker().wake_by_ref();
    }
}
