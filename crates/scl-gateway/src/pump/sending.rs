//! Messages that leave this host.

use super::local_end::{BATCH, Timer, end_name, names, window};
use super::{Carry, Pump, running};
use crate::slot::Held;
use crate::wire::{Announced, SenderEvent, WireSender};
use scl::bridge::Mirror;
use scl::transport::{Receiver, Resumed, Transport};
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

/// How long a sending component may take to stop sending before the local end is closed anyway. Only a component that
/// hangs, or an old release, takes that long; what it sends in that time counts as lost there.
const FINISH_LIMIT: Duration = Duration::from_secs(1);
/// How long a publisher that has ended still counts as running for the far host because its last messages are in
/// flight.
const DRAIN_LIMIT: Duration = Duration::from_secs(2);

/// Carries the messages of a route from components of this host to the wire.
#[derive(Default)]
pub(crate) struct Sending {
    /// The publisher's run that the far host knows, and the timer that limits how long it is held after the publisher
    /// has ended. As long as the run is held, the publisher counts as running for other hosts.
    run: Option<Held<Announced>>,
    draining: Timer,
    local: Option<Local>,
    /// Number of messages taken from components here, of those taken by the far component or given up, and of those
    /// acknowledged to components here.
    sent: u64,
    settled: u64,
    told: u64,
    /// The last message that the far side was asked to acknowledge.
    asked: u64,
    /// Identifies the far component to a latched publisher; replaced when the far component needs the last message.
    resumed: Option<Resumed>,
    /// Whether the far component has started and received no message since.
    wants_last: bool,
}

/// Dropped in this order: the mirror must outlive its ends.
struct Local {
    receiver: Box<dyn Receiver>,
    mirror: Held<Mirror>,
    finishing: bool,
    /// Whether this end is to be replaced by a new one, to which a latched publisher sends its last message.
    is_outdated: bool,
    limit: Timer,
}

impl Carry for Pump<WireSender, Sending> {
    fn poll(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        while let Poll::Ready(event) = self.wire.poll_event(cx) {
            self.handle(event);
        }
        self.check_account();
        self.follow_publisher();
        self.open_or_finish(cx);
        self.carry(cx);
        self.close_if_finished(cx);
        self.end_run_if_drained(cx);
        self.check_account();
        self.counts.set_held(self.state.sent - self.state.settled);
        if self.stopping && self.state.local.is_none() { Poll::Ready(()) } else { Poll::Pending }
    }
}

impl Pump<WireSender, Sending> {
    fn handle(&mut self, event: SenderEvent) {
        match event {
            SenderEvent::Matched => self.matched = true,
            SenderEvent::Unmatched => self.matched = false,
            SenderEvent::NewReceiver => self.rejoin(),
            SenderEvent::Acknowledged(number) => {
                self.counts.add_carried(number.saturating_sub(self.state.settled));
                self.settle(number);
            }
            SenderEvent::GivenUp(count) => {
                self.counts.add_given_up(count);
                let (from, to) = (end_name(&self.route.from), end_name(&self.route.to));
                tracing::warn!("{count} messages from {from} to {to} were on their way when {to} was lost; given up");
                self.settle(self.state.settled + count);
            }
        }
    }

    /// Asserts, in debug builds, that the account of this route agrees with that of its end of the wire.
    fn check_account(&self) {
        let Sending { sent, settled, told, .. } = self.state;
        debug_assert_eq!(sent, settled + self.wire.unacknowledged(), "each message is settled once");
        debug_assert!(settled <= told && told <= sent, "{settled} settled, {told} acknowledged, {sent} sent");
    }

    /// Makes a latched publisher send its last message to the far component, which has just started, unless messages
    /// are still in flight.
    fn rejoin(&mut self) {
        if self.wire.unacknowledged() > 0 {
            return;
        }
        self.state.wants_last = true;
        if let Some(local) = &mut self.state.local {
            local.is_outdated = true;
        }
    }

    /// Settles all messages up to a number, which the far component has taken or which were given up.
    fn settle(&mut self, number: u64) {
        let state = &mut self.state;
        state.settled = state.settled.max(number).min(state.sent);
        if state.settled > state.told {
            if let Some(local) = &mut state.local {
                local.receiver.acknowledge(state.settled - state.told);
            }
            state.told = state.settled;
        }
    }

    /// Opens this side of the wire once the publisher runs, and starts the time limit when it has ended.
    fn follow_publisher(&mut self) {
        // Any component may push, so there is no publisher to wait for.
        if self.component.is_none() {
            return self.wire.set_open(true);
        }
        match (&self.state.run, running(&self.component)) {
            (None, Some(run)) => {
                self.state.run = Some(run);
                self.wire.set_open(true);
            }
            (Some(_), None) => self.state.draining.start(DRAIN_LIMIT),
            _ => {}
        }
    }

    fn open_or_finish(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let mirror = running(&self.mirror).filter(|_| self.matched && !self.stopping);
        let mirror = mirror.filter(|_| self.component.is_none() || state.run.is_some());
        match (&mut state.local, mirror) {
            (None, Some(mirror)) => {
                let (route, transport) = (&self.route, &self.transport);
                if std::mem::take(&mut state.wants_last) {
                    state.resumed = Some(Resumed::new_end());
                }
                let resumed = state.resumed;
                let receiver = self.attempts.open(cx, route, || {
                    let (gate, window) = (names(&route.to).1, window(route));
                    Ok(match names(&route.from) {
                        ("", _) => transport.pull(&mirror.pulling(gate, window)?)?,
                        publisher => {
                            let mut endpoint = mirror.subscribing(gate, publisher, window)?;
                            endpoint.resumed = resumed;
                            transport.subscribe(&endpoint)?
                        }
                    })
                });
                let local = |receiver| Local {
                    receiver,
                    mirror,
                    finishing: false,
                    is_outdated: false,
                    limit: Timer::default(),
                };
                state.local = receiver.map(local);
            }
            (Some(local), mirror) => {
                let is_wanted = mirror.is_some_and(|mirror| Arc::ptr_eq(&mirror, &local.mirror)) && !local.is_outdated;
                if !is_wanted && !std::mem::replace(&mut local.finishing, true) {
                    local.receiver.finish();
                    local.limit.start(FINISH_LIMIT);
                }
            }
            (None, None) => {}
        }
    }

    /// Carries messages as far as the window allows. While the local end is finishing, carries all of them: no more
    /// than one window is in flight.
    fn carry(&mut self, cx: &mut Context<'_>) {
        let Some(local) = &mut self.state.local else { return };
        let mut taken = 0;
        loop {
            if !local.finishing && !self.wire.may_send(0) {
                local.receiver.connect(cx);
                break;
            }
            if taken == BATCH {
                cx.waker().wake_by_ref();
                break;
            }
            let Poll::Ready(message) = local.receiver.poll_recv(cx) else { break };
            self.state.sent += 1;
            self.state.wants_last = false;
            self.state.resumed.iter_mut().for_each(|resumed| resumed.taken += 1);
            match local.receiver.take_latched() {
                Some(sent) => self.wire.send_latched(message, sent),
                None => self.wire.send(message),
            }
            taken += 1;
        }
        if local.receiver.take_acknowledgement_request() {
            self.wire.request_acknowledgement();
        }
    }

    /// Closes the finishing local end when nothing is in flight into it, or when its time limit is over. From then on
    /// its messages are in this gateway's custody.
    fn close_if_finished(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let Some(local) = state.local.as_mut().filter(|local| local.finishing) else { return };
        let is_over = local.limit.is_over(cx);
        if !local.receiver.is_finished() && !is_over {
            return;
        }
        if self.stopping {
            // The gateway keeps nothing from here on: messages that the far side does not take count as lost.
            if self.wire.unacknowledged() > 0 && self.matched && !is_over {
                return self.ask_far_side();
            }
        } else {
            local.receiver.acknowledge(state.sent - state.told);
            state.told = state.sent;
        }
        state.local = None;
        // Poll again, because a new mirror may exist already.
        cx.waker().wake_by_ref();
    }

    fn ask_far_side(&mut self) {
        if std::mem::replace(&mut self.state.asked, self.state.sent) != self.state.sent {
            self.wire.request_acknowledgement();
        }
    }

    /// Withdraws the publisher's run from the far host once all its messages have been acknowledged, or when the time
    /// limit is over.
    fn end_run_if_drained(&mut self, cx: &mut Context<'_>) {
        let state = &mut self.state;
        let has_ended = state.run.is_some() && running(&self.component).is_none();
        if !has_ended {
            return;
        }
        let is_read = state.local.as_ref().is_none_or(|local| local.receiver.peers() == 0);
        if (is_read && self.wire.unacknowledged() == 0) || state.draining.is_over(cx) {
            state.draining.stop();
            state.local = None;
            state.run = None;
            self.wire.set_open(false);
            // Poll again, because the publisher may already be running again.
            cx.waker().wake_by_ref();
        } else if is_read {
            self.ask_far_side();
        }
    }
}
