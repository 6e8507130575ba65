//! A plain ZeroMQ subscriber of a `pub` gate, with a queue of its own so that it never delays the component.

use super::queue::{Queue, QueuePolicy};
use crate::transport::{Disconnected, Frame, Link};
use bytes::Bytes;
use std::collections::VecDeque;
use std::task::Context;

pub(super) struct ForeignPeer {
    link: Box<dyn Link>,
    queue: Queue<Frame>,
    sent: u64,
}

impl ForeignPeer {
    /// A subscriber that is to receive `waiting` first.
    pub(super) fn new(link: Box<dyn Link>, policy: QueuePolicy, waiting: VecDeque<Frame>) -> Self {
        let mut queue = Queue::new(policy);
        *queue.items_mut() = waiting;
        Self { link, queue, sent: 0 }
    }

    pub(super) fn send(&mut self, cx: &mut Context<'_>, message: Bytes) {
        if self.queue.is_full() {
            self.hand_over(cx);
        }
        let mut message = Frame::from(message);
        if self.queue.is_empty() {
            message = match self.link.send(cx, message) {
                Ok(()) => {
                    self.sent += 1;
                    return;
                }
                Err(message) => message,
            };
        }
        self.queue.push(message);
    }

    pub(super) fn drive(&mut self, cx: &mut Context<'_>) -> Result<(), Disconnected> {
        self.link.drive(cx)?;
        self.hand_over(cx);
        Ok(())
    }

    pub(super) fn is_full(&self) -> bool {
        self.queue.is_full()
    }

    pub(super) fn is_flushed(&self) -> bool {
        self.queue.is_empty() && self.link.is_written()
    }

    pub(super) fn sent(&self) -> u64 {
        self.sent
    }

    pub(super) fn dropped(&self) -> u64 {
        self.queue.dropped_oldest + self.queue.dropped_newest
    }

    pub(super) fn detach(&mut self) {
        self.link.detach();
    }

    fn hand_over(&mut self, cx: &mut Context<'_>) {
        let sent = &mut self.sent;
        self.link.send_all(cx, self.queue.items_mut(), &mut |_length| *sent += 1);
    }
}
