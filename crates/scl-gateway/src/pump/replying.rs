//! Requests that arrive at this host.

use super::Counts;
use super::local_end::{Attempts, BATCH, MOST_OPEN};
use crate::route::Route;
use crate::slot::View;
use crate::wire::{Announced, ReplierEvent, WireReplier};
use scl::transport::zeromq::ZeroMq;
use scl::transport::{Answer, Endpoint, Requester, Transport};
use std::collections::BTreeSet;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::sync::watch;

/// Carries the requests of a route from the wire to the replying component of this host, and the replies back.
pub(crate) struct Replying {
    pub(crate) route: Route,
    pub(crate) wire: WireReplier,
    /// The replying component here.
    pub(crate) component: View<Announced>,
    pub(crate) transport: Arc<ZeroMq>,
    pub(crate) counts: Arc<Counts>,
    pub(crate) state: State,
}

#[derive(Default)]
pub(crate) struct State {
    matched: bool,
    open: bool,
    local: Option<Box<dyn Requester>>,
    attempts: Attempts,
    /// Requests without a reply.
    unanswered: BTreeSet<u64>,
}

impl Replying {
    /// Runs until the gateway ends.
    pub(crate) async fn run(mut self, mut stop: watch::Receiver<bool>) {
        let mut component = self.component.clone();
        loop {
            let alive = tokio::select! {
                changed = component.changed() => changed.is_ok(),
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
        self.open_or_close(cx);
        self.connect(cx);
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            match event {
                ReplierEvent::Matched => self.state.matched = true,
                ReplierEvent::Unmatched => self.state.matched = false,
                ReplierEvent::Request { id, body } => self.request(cx, id, body),
            }
            self.open_or_close(cx);
            self.connect(cx);
        }
        self.carry(cx);
        self.counts.set_held(self.state.unanswered.len() as u64);
        Poll::Pending
    }

    fn open_or_close(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        // Without a component to connect to, nothing is tried.
        let is_wanted = state.matched && self.component.borrow().is_some();
        if !is_wanted && state.local.take().is_some() {
            self.close();
        } else if is_wanted && state.local.is_none() {
            let (route, transport) = (&self.route, &self.transport);
            let mut endpoint = Endpoint::accepting(route.endpoint.clone(), route.max_size);
            endpoint.in_flight = MOST_OPEN;
            state.local = state.attempts.open(cx, route, || Ok(transport.request(&endpoint)?));
        }
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        // Once connected, this would discard replies.
        if let Some(local) = state.local.as_mut().filter(|_| !state.open)
            && local.poll_connected(cx).is_ready()
        {
            state.open = true;
            self.wire.set_open(true);
        }
    }

    /// The component is gone: no request gets a reply any more.
    fn close(&mut self) {
        let state = &mut self.state;
        self.counts.add_given_up(state.unanswered.len() as u64);
        state.unanswered.clear();
        if std::mem::replace(&mut state.open, false) {
            self.wire.set_open(false);
        }
    }

    fn request(&mut self, cx: &mut Context<'_>, id: u64, body: bytes::Bytes) {
        let sent = self.state.local.as_mut().is_some_and(|local| local.request(cx, id, body).is_ok());
        if sent {
            self.state.unanswered.insert(id);
            if self.state.unanswered.len() > MOST_OPEN
                && let Some(oldest) = self.state.unanswered.pop_first()
            {
                self.counts.add_given_up(1);
                self.wire.give_up(oldest);
            }
        } else {
            self.wire.give_up(id);
        }
    }

    fn carry(&mut self, cx: &mut Context<'_>) {
        for _ in 0..BATCH {
            let Some(local) = self.state.local.as_mut().filter(|_| self.state.open) else { return };
            match local.poll_answer(cx) {
                Poll::Ready(Answer::Reply { id, body }) => {
                    if self.state.unanswered.remove(&id) {
                        self.counts.add_carried(1);
                        self.wire.reply(id, body);
                    }
                }
                Poll::Ready(Answer::Refused { id }) => {
                    if self.state.unanswered.remove(&id) {
                        self.counts.add_given_up(1);
                        self.wire.refuse(id);
                    }
                }
                Poll::Ready(Answer::Lost) => {
                    self.close();
                    self.connect(cx);
                }
                Poll::Pending => return,
            }
        }
        cx.waker().wake_by_ref();
    }
}
