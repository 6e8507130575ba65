//! A plain ZeroMQ subscriber of a `pub` gate, with a queue of its own so that it never delays the component.

use super::queue::{Queue, QueuePolicy};
use super::stats::Activity;
use crate::transport::{Disconnected, Driven, Frame, Link};
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::Context;

pub(super) struct ForeignPeer {
    link: Box<dyn Link>,
    queue: Queue<Frame>,
    sent: u64,
    activity: Activity,
    latches: bool,
    /// The last message of a latched gate, while the subscriber has not subscribed to it.
    unwanted: Option<Bytes>,
}

/// What became of the messages for some peers of a connection.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Handed to them.
    pub(crate) sent: u64,
    /// Replaced by newer ones, because only the newest counts.
    pub(crate) replaced: u64,
    /// Dropped because plain ZeroMQ subscribers read slowly.
    pub(crate) dropped_for_observers: u64,
    pub(crate) activity: Activity,
}

impl Counts {
    pub(super) fn plus(self, other: Self) -> Self {
        Self {
            sent: self.sent + other.sent,
            replaced: self.replaced + other.replaced,
            dropped_for_observers: self.dropped_for_observers + other.dropped_for_observers,
            activity: self.activity.plus(other.activity),
        }
    }
}

impl ForeignPeer {
    /// Creates a subscriber that receives `waiting` first. With `latches`, it gets the last message even if it
    /// subscribes to that later.
    pub(super) fn new(link: Box<dyn Link>, policy: QueuePolicy, mut waiting: VecDeque<Frame>, latches: bool) -> Self {
        let is_unwanted = |last: &mut Frame| latches && !link.wants(last.as_slice());
        let unwanted = waiting.pop_back_if(is_unwanted).map(Frame::into_bytes);
        let mut queue = Queue::new(policy);
        *queue.items_mut() = waiting;
        Self { link, queue, sent: 0, activity: Activity::default(), latches, unwanted }
    }

    pub(super) fn send(&mut self, cx: &mut Context<'_>, message: Bytes) {
        if self.latches && !self.link.wants(&message) {
            self.unwanted = Some(message);
            return;
        }
        self.unwanted = None;
        if self.queue.is_full() {
            self.hand_over(cx, None);
        }
        let length = message.len();
        let message = Frame::from(message);
        let returned = if self.queue.is_empty() { self.link.send(cx, message).returned() } else { Some(message) };
        match returned {
            None => {
                self.sent += 1;
                self.activity.add(length);
            }
            Some(message) => {
                self.queue.push(message);
            }
        }
    }

    pub(super) fn drive(&mut self, cx: &mut Context<'_>) -> Result<(), Disconnected> {
        let driven = self.link.drive(cx)?;
        if let Some(last) = self.unwanted.take_if(|last| self.link.wants(last)) {
            self.queue.push(last.into());
        }
        self.hand_over(cx, Some(driven));
        Ok(())
    }

    pub(super) fn is_full(&self) -> bool {
        self.queue.is_full()
    }

    pub(super) fn is_flushed(&self) -> bool {
        self.queue.is_empty() && self.link.is_written()
    }

    pub(super) fn counts(&self) -> Counts {
        let Queue { replaced, dropped_oldest, dropped_newest, .. } = self.queue;
        let dropped_for_observers = dropped_oldest + dropped_newest;
        Counts { sent: self.sent, replaced, dropped_for_observers, activity: self.activity }
    }

    pub(super) fn detach(&mut self) {
        self.link.detach();
    }

    fn hand_over(&mut self, cx: &mut Context<'_>, driven: Option<Driven>) {
        let Self { link, queue, sent, activity, .. } = self;
        link.send_all(cx, driven, queue.items_mut(), &mut |length| {
            *sent += 1;
            activity.add(length);
        });
    }
}
