//! A receiving end: applies the decisions, and sends acknowledgements through the thread.

use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Instant;

use bytes::Bytes;

use super::incoming::Incoming;
use crate::wire::WINDOW_BYTES;
use crate::wire::command::{Command, Commands, Declared, EndId};
use crate::wire::mailbox::{Mailbox, ReceivingMail};

/// Event of a receiving end, and of [`WireReceiver::poll_event`](crate::wire::WireReceiver::poll_event).
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum ReceiverEvent {
    /// The sending side is open.
    Matched,
    /// The sending side closed, or the link is lost.
    Unmatched,
    /// The next message was sent at this time, before this side was opened.
    Latched(Instant),
    /// The next message. Messages are numbered 1, 2, 3, ... since the last `set_open(true)`.
    Message(Bytes),
    /// The sending component wants its messages acknowledged now, for a flush.
    AcknowledgementRequested,
}

#[derive(Debug)]
pub(in crate::wire) struct ReceivingEnd {
    declared: Declared,
    mail: Arc<Mailbox<ReceivingMail>>,
    key: String,
    max_size: u64,
    incoming: Option<Incoming>,
    /// The message to return next, after its `Latched` event.
    latched: Option<Bytes>,
    is_matched: bool,
    flush: bool,
    warned: bool,
}

impl ReceivingEnd {
    /// Creates an end that receives what `host` sends on `key`. It is closed at first.
    pub(in crate::wire) fn new(commands: &Commands, host: &str, key: &str, max_size: u64) -> Self {
        // Twice what the sender may have in flight, because it may have started over.
        let mail = Arc::new(Mailbox::new(2 * max_size.saturating_add(4 * WINDOW_BYTES)));
        let (host, key, thread_mail) = (host.to_owned(), key.to_owned(), Arc::clone(&mail));
        let declared_key = key.clone();
        let declare = |id| Command::AddReceiving { id, host, key: declared_key, mail: thread_mail };
        ReceivingEnd {
            declared: Declared::new(commands, declare),
            mail,
            key,
            max_size,
            incoming: None,
            latched: None,
            is_matched: false,
            flush: false,
            warned: false,
        }
    }

    pub(in crate::wire) fn mail(&self) -> Arc<Mailbox<ReceivingMail>> {
        Arc::clone(&self.mail)
    }

    pub(in crate::wire) fn id(&self) -> EndId {
        self.declared.id()
    }

    pub(in crate::wire) fn open(&mut self, epoch: u64) {
        self.incoming = Some(Incoming::new(epoch, self.max_size));
    }

    pub(in crate::wire) fn close(&mut self) {
        self.incoming = None;
        (self.latched, self.flush) = (None, false);
    }

    pub(in crate::wire) fn acknowledge(&mut self, count: u64) {
        if let Some(ack) = self.incoming.as_mut().and_then(|incoming| incoming.acknowledge(count)) {
            self.declared.send(|id| Command::Acknowledge { id, ack });
        }
    }

    pub(in crate::wire) fn poll(&mut self, cx: &mut Context<'_>) -> Poll<ReceiverEvent> {
        loop {
            if let Some(message) = self.latched.take() {
                return Poll::Ready(ReceiverEvent::Message(message));
            }
            if std::mem::take(&mut self.flush) {
                return Poll::Ready(ReceiverEvent::AcknowledgementRequested);
            }
            let Poll::Ready(mail) = self.mail.poll(cx) else { return Poll::Pending };
            let (header, payload) = match mail {
                ReceivingMail::Peer(peer) if peer.is_some() == self.is_matched => continue,
                ReceivingMail::Peer(peer) => {
                    self.is_matched = peer.is_some();
                    let event = if self.is_matched { ReceiverEvent::Matched } else { ReceiverEvent::Unmatched };
                    return Poll::Ready(event);
                }
                ReceivingMail::Arrived(header, payload) => (header, payload),
            };
            let Some(incoming) = &mut self.incoming else { continue };
            let outcome = incoming.accept(header, payload);
            if outcome.too_large && !std::mem::replace(&mut self.warned, true) {
                tracing::error!("`{}` carries a message of more than {} bytes; it is refused", self.key, self.max_size);
            }
            if let Some(ack) = outcome.answer {
                self.declared.send(|id| Command::Acknowledge { id, ack });
            }
            self.flush |= outcome.flush;
            if let Some(message) = outcome.message {
                let Some(sent) = outcome.latched else { return Poll::Ready(ReceiverEvent::Message(message)) };
                self.latched = Some(message);
                return Poll::Ready(ReceiverEvent::Latched(sent));
            }
        }
    }
}
