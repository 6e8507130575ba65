//! Requests that arrive at this host.

use super::local_end::{BATCH, MOST_OPEN};
use super::{Carry, Pump, running};
use crate::wire::{ReplierEvent, WireReplier};
use scl::transport::{Answer, Endpoint, Requester, Transport};
use std::collections::BTreeSet;
use std::task::{Context, Poll};

/// Carries the requests of a route from the wire to the replying component of this host, and the replies back.
#[derive(Default)]
pub(crate) struct Replying {
    open: bool,
    local: Option<Box<dyn Requester>>,
    /// Requests without a reply.
    unanswered: BTreeSet<u64>,
}

impl Carry for Pump<WireReplier, Replying> {
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // Do not wait for open requests: their requesters notice at once that no reply will come.
        if self.stopping {
            return Poll::Ready(());
        }
        self.open_or_close(cx);
        self.connect(cx);
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            match event {
                ReplierEvent::Matched => self.matched = true,
                ReplierEvent::Unmatched => self.matched = false,
                ReplierEvent::Request { id, body } => self.request(cx, id, body),
            }
            self.open_or_close(cx);
            self.connect(cx);
        }
        self.carry(cx);
        self.counts.set_held(self.state.unanswered.len() as u64);
        Poll::Pending
    }
}

impl Pump<WireReplier, Replying> {
    fn open_or_close(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        // Do not try to connect while the component is not running.
        let is_wanted = self.matched && running(&self.component).is_some();
        if !is_wanted && state.local.take().is_some() {
            self.close();
        } else if is_wanted && state.local.is_none() {
            let (route, transport) = (&self.route, &self.transport);
            let mut endpoint = Endpoint::accepting(route.endpoint.clone(), route.max_size);
            endpoint.in_flight = MOST_OPEN;
            state.local = self.attempts.open(cx, route, || Ok(transport.request(&endpoint)?));
        }
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        // Only until connected, because `poll_connected` discards replies.
        if let Some(local) = state.local.as_mut().filter(|_| !state.open)
            && local.poll_connected(cx).is_ready()
        {
            state.open = true;
            self.wire.set_open(true);
        }
    }

    /// Gives up all unanswered requests, because the component is gone.
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
