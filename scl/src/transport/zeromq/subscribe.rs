//! The subscribing end of one connection: a SUB socket to its publisher.

use super::credit::receiving;
use super::dialler::Dialler;
use super::inbound::Inbound;
use super::zmtp::{SUBSCRIBE_ALL, SocketType};
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, Receiver};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

pub(super) struct Subscriber {
    dialler: Dialler,
    publisher: Option<Inbound>,
    malformed: u64,
    /// For an end whose caller acknowledges messages: how many are not acknowledged, of publishers that are lost and of
    /// the connected one.
    stale: u64,
    untold: u64,
    finishing: bool,
}

impl Subscriber {
    pub(super) fn open(dir: &Arc<SystemDir>, endpoint: &Endpoint) -> Self {
        let dialler = Dialler::new(dir, endpoint, SocketType::Sub, receiving(endpoint));
        Self { dialler, publisher: None, malformed: 0, stale: 0, untold: 0, finishing: false }
    }

    /// Connects to the publisher, while there is none.
    fn poll_publisher(&mut self, cx: &mut Context<'_>) -> Poll<&mut Inbound> {
        let (mut connection, ready) = ready!(self.dialler.poll_connected(cx));
        // Not earlier: libzmq closes a connection on which this arrives together with READY.
        let _reported_by_reading = connection.write(SUBSCRIBE_ALL);
        let mut inbound = Inbound::new(connection, &ready, self.dialler.endpoint(), self.dialler.dir());
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
                    self.untold += u64::from(self.dialler.endpoint().deferred.is_some());
                    return Poll::Ready(message);
                }
                Poll::Ready(Err(error)) => {
                    tracing::debug!(endpoint = %self.dialler.endpoint().name, %error, "lost the publisher");
                    self.publisher = None;
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
