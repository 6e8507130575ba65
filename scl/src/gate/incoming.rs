//! What `sub` and `pull` share: frames from one or several links, the gate's own queue, decoding.

use super::stats::{Counts, GateStats};
use super::{GateName, Peers};
use crate::codec::{Codec, DecodeError};
use crate::component::Core;
use crate::error::{RecvError, RecvTimeoutError};
use crate::spec::{GateSpec, LinkSpec, WhenFull};
use crate::transport::Inlet;
use bytes::Bytes;
use std::collections::VecDeque;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use std::time::Duration;

/// How many messages one call takes in at most, so that a peer that sends faster than they are taken in ends no call.
const TAKE_IN: usize = 1024;

pub(crate) struct Incoming<T> {
    pub(crate) spec: &'static GateSpec,
    name: GateName,
    links: Vec<Box<dyn Inlet>>,
    /// The link to ask first, so that none is kept waiting by another.
    next: usize,
    inbox: VecDeque<Arrived>,
    /// Whether the last receiving call found nothing.
    waiting: bool,
    decode: fn(Bytes) -> Result<T, DecodeError>,
    counts: Counts,
    /// Let go after the links, whose endpoints are this component's only as long as it has its name.
    pub(crate) core: Arc<Core>,
}

struct Arrived {
    link: usize,
    frame: Bytes,
}

impl<T> Incoming<T> {
    pub(crate) fn new<C: Codec<T>>(core: Arc<Core>, spec: &'static GateSpec, links: Vec<Box<dyn Inlet>>) -> Self {
        let name = GateName::new(core.spec().name, spec.name);
        let inbox = VecDeque::new();
        Self { core, spec, name, links, next: 0, inbox, waiting: false, decode: C::decode, counts: Counts::default() }
    }

    pub(crate) async fn recv(&mut self) -> Result<T, RecvError> {
        poll_fn(|cx| self.poll_recv(cx)).await
    }

    pub(crate) fn recv_blocking(&mut self) -> Result<T, RecvError> {
        let core = Arc::clone(&self.core);
        core.block_on(self.recv()).map_err(|source| RecvError::Blocking { gate: self.name, source })?
    }

    pub(crate) fn recv_timeout(&mut self, timeout: Duration) -> Result<T, RecvTimeoutError> {
        let core = Arc::clone(&self.core);
        let received = core.block_on(async { tokio::time::timeout(timeout, self.recv()).await });
        match received {
            Ok(Ok(received)) => received.map_err(RecvTimeoutError::Recv),
            Ok(Err(_elapsed)) => {
                Err(RecvTimeoutError::Timeout { gate: self.name, peers: Peers(self.spec.links), waited: timeout })
            }
            Err(source) => Err(RecvTimeoutError::Recv(RecvError::Blocking { gate: self.name, source })),
        }
    }

    pub(crate) fn poll_recv(&mut self, cx: &mut Context<'_>) -> Poll<Result<T, RecvError>> {
        // What ends a wait is the first to arrive since, so a queue of several has nothing to give way to.
        let ended_wait = self.waiting && self.spec.queue > 1;
        if ended_wait && let Poll::Ready(arrived) = self.poll_links(cx) {
            self.waiting = false;
            self.counts.moved(arrived.frame.len());
            return Poll::Ready(self.decode(arrived));
        }
        if !ended_wait {
            self.take_in(cx);
        }
        let first = self.inbox.pop_front();
        self.waiting = first.is_none();
        first.map_or(Poll::Pending, |arrived| Poll::Ready(self.decode(arrived)))
    }

    pub(crate) fn try_recv(&mut self) -> Result<Option<T>, RecvError> {
        self.look()?;
        self.inbox.pop_front().map(|arrived| self.decode(arrived)).transpose()
    }

    pub(crate) fn latest(&mut self) -> Result<Option<T>, RecvError> {
        self.look()?;
        let mut newest = self.inbox.pop_back();
        self.inbox.clear();
        if self.spec.when_full == WhenFull::Wait {
            // Such a gate takes in one message at a time, but what is passed over keeps no publisher waiting.
            for _ in 0..TAKE_IN {
                let Poll::Ready(newer) = self.poll_links(&mut Context::from_waker(Waker::noop())) else { break };
                self.counts.moved(newer.frame.len());
                newest = Some(newer);
            }
        }
        newest.map(|arrived| self.decode(arrived)).transpose()
    }

    /// Takes in what has arrived without waiting for more.
    fn look(&mut self) -> Result<(), RecvError> {
        let core = Arc::clone(&self.core);
        let blocking = |source| RecvError::Blocking { gate: self.name, source };
        if core.owns_runtime() {
            // Nothing is seen to arrive unless the runtime looks.
            core.block_on(tokio::task::yield_now()).map_err(blocking)?;
        }
        self.waiting = false;
        self.take_in(&mut Context::from_waker(Waker::noop()));
        Ok(())
    }

    /// Moves what has arrived into the inbox, as much as the gate's queue allows; whoever waits is woken by the rest.
    fn take_in(&mut self, cx: &mut Context<'_>) {
        let waits = self.spec.when_full == WhenFull::Wait;
        let capacity = self.spec.queue as usize;
        for _ in 0..TAKE_IN {
            // A publisher that waits for this gate is given room only by the messages that are asked for.
            if waits && !self.inbox.is_empty() {
                return;
            }
            let Poll::Ready(arrived) = self.poll_links(cx) else { return };
            self.counts.moved(arrived.frame.len());
            if self.inbox.len() >= capacity {
                let newest = self.spec.when_full == WhenFull::DropNewest;
                self.counts.dropped(newest);
                if newest {
                    continue;
                }
                self.inbox.pop_front();
            }
            self.inbox.push_back(arrived);
        }
    }

    fn poll_links(&mut self, cx: &mut Context<'_>) -> Poll<Arrived> {
        let count = self.links.len();
        for offset in 0..count {
            let link = (self.next + offset) % count;
            if let Poll::Ready(frame) = self.links[link].poll_recv(cx) {
                self.next = (link + 1) % count;
                return Poll::Ready(Arrived { link, frame });
            }
        }
        Poll::Pending
    }

    fn decode(&mut self, arrived: Arrived) -> Result<T, RecvError> {
        (self.decode)(arrived.frame).map_err(|source| {
            self.counts.rejected += 1;
            // A listening gate has one link for all its peers, so any of them may have sent this.
            let peers = if self.links.len() == self.spec.links.len() {
                &self.spec.links[arrived.link..=arrived.link]
            } else {
                self.spec.links
            };
            RecvError::Decode { gate: self.name, peers: Peers(peers), source }
        })
    }

    pub(crate) fn missing(&self) -> Vec<&'static LinkSpec> {
        let links = self.spec.links.iter().zip(&self.links);
        links.filter(|(spec, link)| spec.required && link.peers() == Some(0)).map(|(spec, _)| spec).collect()
    }

    pub(crate) fn stats(&self) -> GateStats {
        let mut stats = GateStats::default();
        self.counts.add_to(&mut stats);
        stats.received = self.counts.messages;
        stats.rejected += self.links.iter().map(|link| link.malformed()).sum::<u64>();
        stats.waiting = self.inbox.len();
        stats.peers = self.links.iter().filter_map(|link| link.peers()).sum();
        stats
    }
}
