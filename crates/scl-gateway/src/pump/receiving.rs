//! Messages that arrive at this host.

use super::local_end::{Timer, names, window};
use super::{Carry, Pump, running};
use crate::slot::Held;
use crate::wire::{ReceiverEvent, WireReceiver};
use scl::bridge::Mirror;
use scl::transport::{Disconnected, Driven, Endpoint, Frame, Link, PeerKind, Sender, Transport};
use std::collections::VecDeque;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::{Duration, Instant};

/// How long the component here may still take received messages after the far one has ended.
const DRAIN_LIMIT: Duration = Duration::from_secs(1);

/// How long a message that nothing follows may wait until the component is asked to acknowledge it. Short enough to
/// keep the figures current and to give up little if this gateway is killed; long enough to cost nothing.
const IDLE_LIMIT: Duration = Duration::from_millis(200);

/// Carries the messages of a route from the wire to the receiving component of this host.
#[derive(Default)]
pub(crate) struct Receiving {
    /// Whether the far side sees this side as open: since the component has connected. Messages that are unacknowledged
    /// in that time are known to be missing, so this side stays open while only the link between the hosts is lost.
    open: bool,
    local: Option<Local>,
    /// Received messages that were not yet handed to the component's link.
    queue: VecDeque<Frame>,
    /// The latched messages: their numbers since this side was opened, and when they were sent.
    latched: VecDeque<(u64, Instant)>,
    /// Messages given to links since this side was opened, and those among them that the component has taken.
    handed: u64,
    confirmed: u64,
    flush: bool,
}

/// Dropped in this order: the mirror must outlive its ends.
struct Local {
    link: Option<Box<dyn Link>>,
    sender: Box<dyn Sender>,
    mirror: Option<Held<Mirror>>,
    /// Started when the mirror is withdrawn. The end is closed when it expires.
    limit: Timer,
    /// Number and total length of the messages handed over since the component was last asked to acknowledge.
    unasked: (u64, u64),
    /// Started at the first of these messages. The component is asked to acknowledge when it expires.
    idle: Timer,
}

impl Carry for Pump<WireReceiver, Receiving> {
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            match event {
                ReceiverEvent::Matched => self.matched = true,
                ReceiverEvent::Unmatched => self.matched = false,
                ReceiverEvent::Latched(sent) => {
                    let number = self.state.handed + self.state.queue.len() as u64 + 1;
                    self.state.latched.push_back((number, sent));
                }
                // Never more than a window, because a message is acknowledged only after the component has taken it.
                ReceiverEvent::Message(message) => self.state.queue.push_back(message.into()),
                ReceiverEvent::AcknowledgementRequested => self.state.flush = true,
            }
        }
        self.close_if_done(cx);
        self.open(cx);
        let driven = self.connect(cx);
        self.carry(cx, driven);
        self.ask(cx);
        self.confirm();
        // `confirm` may have acknowledged the last pending message.
        self.close_if_done(cx);
        self.counts.set_held(self.state.pending());
        if self.stopping && self.state.pending() == 0 { Poll::Ready(()) } else { Poll::Pending }
    }

    /// Ends the epoch if the component is not connected, because it will not take its messages any more.
    fn component_changed(&mut self) {
        if self.state.local.as_ref().is_none_or(|local| local.link.is_none()) {
            self.end_epoch();
        }
    }
}

impl Pump<WireReceiver, Receiving> {
    /// Closes the local end when the far side is gone and the component has taken everything, or when its time limit is
    /// over.
    fn close_if_done(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let pending = state.pending();
        let Some(local) = &mut state.local else { return };
        let now = running(&self.mirror);
        let is_shown = local.mirror.as_ref().is_none_or(|mirror| now.is_some_and(|now| Arc::ptr_eq(&now, mirror)));
        if !is_shown {
            local.limit.start(DRAIN_LIMIT);
        }
        if (pending == 0 && !(self.matched && is_shown)) || local.limit.is_over(cx) {
            if pending > 0 {
                self.end_epoch();
            }
            self.state.local = None;
            // Poll again, because a new mirror may exist already.
            cx.waker().wake_by_ref();
        }
    }

    fn open(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        if state.local.is_some() || !(self.matched || state.pending() > 0) {
            return;
        }
        let (route, transport) = (&self.route, &self.transport);
        let (component, gate) = names(&route.from);
        let opened = match (&self.mirror, running(&self.mirror)) {
            (Some(_), None) => return,
            (Some(_), Some(mirror)) => {
                debug_assert!(!component.is_empty(), "a publisher has a name");
                let open = || Ok(transport.publish(&mirror.publishing(gate, names(&route.to))?)?);
                self.attempts.open(cx, route, open).map(|sender| (sender, Some(mirror)))
            }
            // Do not try while the component is not running.
            (None, _) if running(&self.component).is_none() => return,
            (None, _) => {
                let mut endpoint = Endpoint::new(route.endpoint.clone());
                (endpoint.lossless, endpoint.queue) = (route.lossless, route.queue as usize);
                self.attempts.open(cx, route, || Ok(transport.push(&endpoint)?)).map(|sender| (sender, None))
            }
        };
        let local = |(sender, mirror)| {
            let (limit, idle) = (Timer::default(), Timer::default());
            Local { link: None, sender, mirror, limit, unasked: (0, 0), idle }
        };
        state.local = opened.map(local);
    }

    /// Accepts connections of the component, and detects when they are lost.
    fn connect(&mut self, cx: &mut Context<'_>) -> Option<Driven> {
        loop {
            while let Some(Poll::Ready(peer)) = self.state.local.as_mut().map(|local| local.sender.poll_peer(cx)) {
                let is_connected = self.state.local.as_ref().is_some_and(|local| local.link.is_some());
                // A plain ZeroMQ program is served in the component's place, not beside it.
                if is_connected && peer.kind == PeerKind::Foreign {
                    continue;
                }
                self.lose_link();
                if !std::mem::replace(&mut self.state.open, true) {
                    self.wire.set_open(true);
                }
                if let Some(local) = &mut self.state.local {
                    (local.link, local.unasked) = (Some(peer.link), (0, 0));
                }
            }
            let link = self.state.local.as_mut().and_then(|local| local.link.as_mut());
            match link.map(|link| link.drive(cx)).transpose() {
                Ok(driven) => return driven,
                Err(Disconnected) => self.lose_link(),
            }
        }
    }

    fn lose_link(&mut self) {
        let Some(local) = &mut self.state.local else { return };
        if let Some(mut link) = local.link.take() {
            link.read_last();
            // Count the component's last acknowledgements.
            let confirmed = self.state.handed - link.unacknowledged();
            self.tell(confirmed);
            drop(link);
            self.end_epoch();
        }
    }

    /// Closes this side of the wire. The far side gives up the messages that the component has not taken; it knows how
    /// many they are.
    fn end_epoch(&mut self) {
        let state = &mut self.state;
        if !std::mem::replace(&mut state.open, false) {
            return;
        }
        let unknown = state.pending();
        if unknown > 0 {
            tracing::debug!(route = %self.route.key, "{unknown} messages were not taken; the far gateway gives them up");
        }
        state.queue.clear();
        state.latched.clear();
        (state.handed, state.confirmed, state.flush) = (0, 0, false);
        self.wire.set_open(false);
    }

    fn carry(&mut self, cx: &mut Context<'_>, mut driven: Option<Driven>) {
        let state = &mut self.state;
        let Some(Local { link: Some(link), unasked, .. }) = &mut state.local else { return };
        let (queue, handed) = (&mut state.queue, &mut state.handed);
        let mut count = |handed: &mut u64, length: usize| {
            *handed += 1;
            *unasked = (unasked.0 + 1, unasked.1 + length as u64);
        };
        while let Some(&(number, sent)) = state.latched.front() {
            let mut rest = queue.split_off(queue.len().min((number - *handed - 1) as usize));
            link.send_all(cx, driven.take(), queue, &mut |length| count(handed, length));
            let is_next = queue.is_empty();
            queue.append(&mut rest);
            let Some(message) = queue.pop_front_if(|_| is_next) else { return };
            let length = message.len();
            if let Some(message) = link.send_latched(cx, message, sent.elapsed()).returned() {
                return queue.push_front(message);
            }
            count(handed, length);
            state.latched.pop_front();
        }
        link.send_all(cx, driven, queue, &mut |length| count(handed, length));
    }

    /// Asks the component to acknowledge when half of the window is in flight, when a message has waited too long, at a
    /// flush, and before the end is closed.
    fn ask(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let window = window(&self.route);
        let Some(Local { link: Some(link), unasked, idle, .. }) = &mut state.local else { return };
        if unasked.0 > 0 {
            idle.start(IDLE_LIMIT);
        }
        let is_due = 2 * unasked.0 >= window.messages || 2 * unasked.1 >= window.bytes || idle.is_over(cx);
        let is_last = state.queue.is_empty() && (state.flush || !self.matched || self.stopping);
        if unasked.0 > 0 && (is_due || is_last) {
            link.request_acknowledgement(cx);
            *unasked = (0, 0);
            idle.stop();
        }
        state.flush &= !state.queue.is_empty();
    }

    fn confirm(&mut self) {
        if let Some(Local { link: Some(link), .. }) = &self.state.local {
            let confirmed = self.state.handed - link.unacknowledged();
            self.tell(confirmed);
        }
    }

    fn tell(&mut self, confirmed: u64) {
        debug_assert!(confirmed <= self.state.handed, "the component has taken no more than it was given");
        if confirmed > self.state.confirmed {
            self.counts.add_carried(confirmed - self.state.confirmed);
            self.state.confirmed = confirmed;
            self.wire.acknowledge(confirmed);
        }
    }
}

impl Receiving {
    /// Returns the number of messages that the component is not known to have taken.
    fn pending(&self) -> u64 {
        self.queue.len() as u64 + self.handed - self.confirmed
    }
}
