//! The end of a connection: what a flush waits for, with and without a runtime.

use super::Connection;
use crate::error::Unflushed;
use crate::gate::foreign::ForeignPeer;
use crate::state::SendingEnd;
use std::task::{Context, Poll, Waker};

impl SendingEnd for Connection {
    fn poll_flushed(&mut self, acknowledged: bool, cx: &mut Context<'_>) -> Poll<()> {
        if !self.waiting_flushes.iter().any(|known| known.will_wake(cx.waker())) {
            self.waiting_flushes.push(cx.waker().clone());
        }
        if acknowledged
            && let Some(link) = &mut self.peer
            && self.queue.is_empty()
            && link.is_written()
            && link.unacknowledged() > 0
        {
            link.request_acknowledgement(&mut Context::from_waker(&self.task));
        }
        let taken = !acknowledged || self.unacknowledged() == 0;
        if !taken || !self.is_written() {
            return Poll::Pending;
        }
        // Wake the other flushes now: the caller may remove the end and its task, which would have woken them.
        self.waiting_flushes.drain(..).filter(|waiting| !waiting.will_wake(cx.waker())).for_each(Waker::wake);
        Poll::Ready(())
    }

    fn waits_for_absent_peer(&self) -> Option<Unflushed> {
        if self.is_connected() || self.queue.is_empty() {
            return None;
        }
        let left = self.report(self.queue.len() as u64);
        (left.lossless || !self.has_completed()).then_some(left)
    }

    fn leftover(&self, acknowledged: bool) -> Option<Unflushed> {
        self.peer.as_ref()?;
        let waiting = self.queue.len() as u64 + if acknowledged { self.unacknowledged() } else { 0 };
        (waiting > 0).then(|| self.report(waiting))
    }

    fn drive(&mut self, cx: &mut Context<'_>) {
        Self::drive(self, cx);
    }

    fn wake_call(&mut self) {
        self.waiting_sender.take().into_iter().for_each(Waker::wake);
    }

    fn call_waits(&self) -> bool {
        self.waiting_sender.is_some()
    }

    fn write_out(&mut self) -> bool {
        if !self.is_written() {
            let task = self.task.clone();
            Self::drive(self, &mut Context::from_waker(&task));
        }
        self.is_written()
    }

    fn detach(&mut self) {
        self.detached = true;
        self.sender.detach();
        self.peer.iter_mut().for_each(|link| link.detach());
        self.foreign.iter_mut().for_each(ForeignPeer::detach);
    }
}

impl Connection {
    fn report(&self, messages: u64) -> Unflushed {
        // A gate does not wait for an optional peer that is not connected.
        let lossless = self.queue.waits() && (self.peer.is_some() || self.link.required);
        Unflushed { gate: self.gate, peer: self.peer_name(), messages, running: false, lossless }
    }

    /// Returns true if all connected peers were given everything.
    fn is_written(&self) -> bool {
        self.peer.as_ref().is_none_or(|link| self.queue.is_empty() && link.is_written())
            && self.foreign.iter().all(ForeignPeer::is_flushed)
    }
}
