//! Requests that leave this host.

use super::local_end::{BATCH, MOST_OPEN, names};
use super::{Carry, Pump, running};
use crate::slot::Held;
use crate::wire::{RequesterEvent, WireRequester};
use bytes::Bytes;
use scl::bridge::Mirror;
use scl::transport::{IncomingRequest, Replier, ReplyPath, Transport};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::task::{Context, Poll};

/// Carries the requests of a route from components of this host to the wire, and the replies back.
#[derive(Default)]
pub(crate) struct Requesting {
    local: Option<Local>,
    /// Envelopes and reply paths of the unanswered requests, by the id under which they are sent over the wire.
    open: BTreeMap<u64, (Bytes, Arc<dyn ReplyPath>)>,
    requests: u64,
}

/// Dropped in this order: the mirror must outlive its ends.
struct Local {
    replier: Box<dyn Replier>,
    mirror: Held<Mirror>,
}

impl Carry for Pump<WireRequester, Requesting> {
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        // Do not wait for open requests: their requesters notice at once that no reply will come.
        if self.stopping {
            return Poll::Ready(());
        }
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            self.handle(event);
        }
        self.open_or_close(cx);
        self.carry(cx);
        self.counts.set_held(self.state.open.len() as u64);
        Poll::Pending
    }
}

impl Pump<WireRequester, Requesting> {
    fn handle(&mut self, event: RequesterEvent) {
        let state = &mut self.state;
        match event {
            RequesterEvent::Matched => self.matched = true,
            RequesterEvent::Unmatched => self.matched = false,
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
            // The requester times out, as with a replier on this host that does not reply.
            RequesterEvent::Gone { id } => {
                let unanswered = state.open.remove(&id);
                self.counts.add_given_up(u64::from(unanswered.is_some()));
            }
        }
    }

    fn open_or_close(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let mirror = running(&self.mirror).filter(|_| self.matched);
        if let Some(local) = &state.local
            && !mirror.as_ref().is_some_and(|mirror| Arc::ptr_eq(mirror, &local.mirror))
        {
            // Close the local end: requesters notice at once that their requests are lost.
            state.local = None;
            self.counts.add_given_up(state.open.len() as u64);
            state.open.clear();
        }
        if let (None, Some(mirror)) = (&state.local, mirror) {
            let (route, transport) = (&self.route, &self.transport);
            let open = || Ok(transport.reply(&mirror.replying(names(&route.to).1)?)?);
            let replier = self.attempts.open(cx, route, open);
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
