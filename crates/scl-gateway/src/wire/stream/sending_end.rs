//! A sending end: applies the decisions, sends through the thread, and times the probes.

use std::collections::VecDeque;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Duration;

use bytes::Bytes;
use tokio::time::{Instant, Sleep};

use super::outgoing::Outgoing;
use crate::wire::command::{Command, Commands, Declared, EndId};
use crate::wire::mailbox::{Mailbox, SendingMail};
use crate::wire::random;

/// Time without progress until the first probe. Probes only find what a gap in the numbers did not show, so this may be
/// well above a round trip.
const FIRST_PROBE: Duration = Duration::from_millis(300);
const LAST_PROBE: Duration = Duration::from_secs(5);

/// Event of a sending end, and of [`WireSender::poll_event`](crate::wire::WireSender::poll_event).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum SenderEvent {
    /// The receiving side is open. If it is the same one as before, unacknowledged messages have been sent again.
    Matched,
    /// Follows `Matched` on a latched route if the receiver is a new one, which has received nothing yet.
    NewReceiver,
    /// The receiving side closed, or the link is lost. Unacknowledged messages stay here for the next match.
    Unmatched,
    /// All messages up to this number are taken by the receiving component (or were given up before).
    Acknowledged(u64),
    /// This many of the oldest messages were unacknowledged when another receiver replaced theirs: whether they arrived
    /// is unknown, and they are not sent again. Follows the `Matched` of the new receiver.
    GivenUp(u64),
}

#[derive(Debug)]
pub(in crate::wire) struct SendingEnd {
    declared: Declared,
    mail: Arc<Mailbox<SendingMail>>,
    outgoing: Outgoing,
    events: VecDeque<SenderEvent>,
    losses: u64,
    pause: Duration,
    timer: Option<Pin<Box<Sleep>>>,
}

impl SendingEnd {
    /// Creates an end that sends on `key` to `host`. With `latches`, a new receiver gets the last waiting message as a
    /// latched one.
    pub(in crate::wire) fn new(commands: &Commands, host: &str, key: &str, queue: u32, latches: bool) -> Self {
        let mail = Arc::new(Mailbox::new(u64::MAX));
        let (host, key, thread_mail) = (host.to_owned(), key.to_owned(), Arc::clone(&mail));
        let declare = |id| Command::AddSending { id, host, key, mail: thread_mail };
        SendingEnd {
            declared: Declared::new(commands, declare),
            mail,
            outgoing: Outgoing::new(queue, latches, random()),
            events: VecDeque::new(),
            losses: 0,
            pause: FIRST_PROBE,
            timer: None,
        }
    }

    pub(in crate::wire) fn mail(&self) -> Arc<Mailbox<SendingMail>> {
        Arc::clone(&self.mail)
    }

    pub(in crate::wire) fn id(&self) -> EndId {
        self.declared.id()
    }

    pub(in crate::wire) fn may_send(&self, length: usize) -> bool {
        self.outgoing.may_push(length)
    }

    pub(in crate::wire) fn is_matched(&self) -> bool {
        self.outgoing.is_matched()
    }

    pub(in crate::wire) fn unacknowledged(&self) -> u64 {
        self.outgoing.unacknowledged() as u64
    }

    pub(in crate::wire) fn losses(&self) -> u64 {
        self.losses
    }

    pub(in crate::wire) fn send(&mut self, message: Bytes, latched: Option<std::time::Instant>) {
        self.outgoing.push(message, latched);
        self.emit();
    }

    pub(in crate::wire) fn request_flush(&mut self) {
        if self.outgoing.request_flush() {
            self.probe();
        }
    }

    /// Forgets everything that is unacknowledged.
    pub(in crate::wire) fn abandon(&mut self) {
        self.declared.send(|id| Command::Clear { id });
        self.outgoing.abandon(random());
    }

    pub(in crate::wire) fn poll(&mut self, cx: &mut Context<'_>) -> Poll<SenderEvent> {
        loop {
            if let Some(event) = self.events.pop_front() {
                return Poll::Ready(event);
            }
            match self.mail.poll(cx) {
                Poll::Ready(mail) => self.handle(mail),
                Poll::Pending => break,
            }
        }
        self.poll_timer(cx);
        Poll::Pending
    }

    fn handle(&mut self, mail: SendingMail) {
        match mail {
            SendingMail::Peer(Some(epoch)) => {
                self.declared.send(|id| Command::Clear { id });
                self.events.push_back(SenderEvent::Matched);
                if self.outgoing.is_new(epoch) {
                    self.events.push_back(SenderEvent::NewReceiver);
                }
                let given_up = self.outgoing.matched(epoch);
                if given_up > 0 {
                    self.events.push_back(SenderEvent::GivenUp(given_up));
                }
                self.restart_timer();
                self.emit();
            }
            SendingMail::Peer(None) => {
                self.declared.send(|id| Command::Clear { id });
                if self.outgoing.is_matched() {
                    self.outgoing.unmatched();
                    self.events.push_back(SenderEvent::Unmatched);
                }
            }
            SendingMail::Ack(ack) => {
                let progress = self.outgoing.acknowledged(&ack);
                if progress.started_over {
                    self.losses += 1;
                    self.declared.send(|id| Command::Clear { id });
                }
                if let Some(settled) = progress.settled {
                    self.events.push_back(SenderEvent::Acknowledged(settled));
                    self.restart_timer();
                }
                self.emit();
            }
        }
    }

    fn emit(&mut self) {
        while let Some((header, message)) = self.outgoing.emit() {
            self.declared.send(|id| Command::Emit { id, header, message });
        }
    }

    fn probe(&mut self) {
        if let Some(header) = self.outgoing.probe() {
            self.declared.send(|id| Command::Emit { id, header, message: Bytes::new() });
        }
    }

    fn restart_timer(&mut self) {
        self.pause = FIRST_PROBE;
        self.timer = None;
    }

    /// Sends probes at increasing intervals while an acknowledgement is outstanding.
    fn poll_timer(&mut self, cx: &mut Context<'_>) {
        while self.outgoing.awaits_answer() {
            let pause = self.pause;
            let timer = self.timer.get_or_insert_with(|| Box::pin(tokio::time::sleep(pause)));
            if timer.as_mut().poll(cx).is_pending() {
                return;
            }
            self.pause = (self.pause * 2).min(LAST_PROBE);
            timer.as_mut().reset(Instant::now() + self.pause);
            self.probe();
        }
        self.timer = None;
    }
}
