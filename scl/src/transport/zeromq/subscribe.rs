//! The subscribing end of one connection: a SUB socket to its publisher.

use super::credit::receiving;
use super::dialler::Dialler;
use super::inbound::Inbound;
use super::zmtp::{SUBSCRIBE_ALL, SocketType, resume};
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, Receiver, Resumed};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::{Duration, Instant};

pub(super) struct Subscriber {
    dialler: Dialler,
    publisher: Option<Inbound>,
    malformed: u64,
    /// If the caller acknowledges messages: how many are not acknowledged, of lost publishers and of the connected one.
    stale: u64,
    untold: u64,
    finishing: bool,
    /// What this end reports to a latched publisher: its number, and how many messages it has taken over lost
    /// connections.
    resumed: Resumed,
}

impl Subscriber {
    pub(super) fn open(dir: &Arc<SystemDir>, endpoint: &Endpoint) -> Self {
        let dialler = Dialler::new(dir, endpoint, SocketType::Sub, receiving(endpoint));
        let resumed = endpoint.resumed.unwrap_or_else(Resumed::new_end);
        Self { dialler, publisher: None, malformed: 0, stale: 0, untold: 0, finishing: false, resumed }
    }

    /// Connects to the publisher. Called while none is connected.
    fn poll_publisher(&mut self, cx: &mut Context<'_>) -> Poll<&mut Inbound> {
        let (mut session, ready) = ready!(self.dialler.poll_connected(cx));
        // Not sent earlier: libzmq closes a connection on which this arrives together with READY.
        if ready.scl.is_some_and(|scl| scl.latched) {
            let _reported_by_reading = session.write(&resume(self.resumed));
        }
        let _reported_by_reading = session.write(SUBSCRIBE_ALL);
        let mut inbound = Inbound::new(session, &ready, &self.dialler.endpoint, &self.dialler.dir);
        if self.finishing {
            inbound.finish();
        }
        Poll::Ready(self.publisher.insert(inbound))
    }
}

impl Receiver for Subscriber {
    fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Bytes> {
        loop {
            let publisher = match &mut self.publisher {
                Some(publisher) => publisher,
                None => ready!(self.poll_publisher(cx)),
            };
            let next = publisher.poll_next(cx);
            self.malformed += publisher.take_malformed();
            match next {
                Poll::Ready(Ok(message)) => {
                    self.untold += u64::from(self.dialler.endpoint.deferred.is_some());
                    return Poll::Ready(message);
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(endpoint = %self.dialler.endpoint.name, %error, "lost the publisher");
                    self.resumed.taken += self.publisher.take().map_or(0, |lost| lost.taken());
                    self.stale += std::mem::take(&mut self.untold);
                }
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn connect(&mut self, cx: &mut Context<'_>) {
        if self.publisher.is_none() {
            let _not_yet = self.poll_publisher(cx).is_pending();
        }
    }

    fn peers(&self) -> usize {
        usize::from(self.publisher.is_some())
    }

    fn is_lossless(&self) -> bool {
        self.publisher.as_ref().is_some_and(Inbound::is_lossless)
    }

    fn is_latched(&self) -> bool {
        self.publisher.as_ref().is_some_and(Inbound::is_latched)
    }

    fn take_latched(&mut self) -> Option<Instant> {
        self.publisher.as_mut().and_then(Inbound::take_latched)
    }

    fn take_sent(&mut self) -> Option<Instant> {
        self.publisher.as_mut().and_then(Inbound::take_sent)
    }

    fn malformed(&self) -> u64 {
        self.malformed
    }

    fn acknowledge(&mut self, count: u64) {
        let stale = count.min(self.stale);
        let count = (count - stale).min(self.untold);
        self.stale -= stale;
        self.untold -= count;
        if let Some(publisher) = self.publisher.as_mut().filter(|_| count > 0) {
            publisher.acknowledge_deferred(count);
        }
    }

    fn note_waiting(&mut self, cx: &mut Context<'_>, waiting: u64) -> bool {
        self.publisher.as_mut().is_some_and(|publisher| publisher.note_waiting(cx, waiting))
    }

    fn acknowledge_last(&mut self) {
        self.publisher.iter_mut().for_each(Inbound::acknowledge_last);
    }

    fn take_acknowledgement_request(&mut self) -> bool {
        self.publisher.as_mut().is_some_and(Inbound::take_acknowledgement_request)
    }

    fn finish(&mut self) {
        self.finishing = true;
        self.publisher.iter_mut().for_each(Inbound::finish);
    }

    fn is_finished(&self) -> bool {
        self.publisher.as_ref().is_none_or(Inbound::is_finished)
    }

    fn forget_answers(&mut self) {
        self.publisher.iter_mut().for_each(Inbound::forget_answer);
    }

    fn poll_caught_up(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        self.publisher.as_mut().map_or(Poll::Ready(()), |publisher| publisher.poll_caught_up(cx))
    }

    fn catch_up(&mut self, within: Duration) {
        if let Some(publisher) = &mut self.publisher {
            publisher.catch_up(within);
        }
    }

    fn wait(&mut self, within: Duration) -> bool {
        self.publisher.as_mut().is_some_and(|publisher| publisher.wait(within))
    }

    fn refusal(&self) -> Option<String> {
        self.dialler.refusal()
    }
}
