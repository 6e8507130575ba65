//! A receiving end: its decisions, and the thread that sends its acknowledgements.

use std::sync::Arc;
use std::task::{Context, Poll};
use std::time::Instant;

use bytes::Bytes;

use super::incoming::Incoming;
use crate::wire::WINDOW_BYTES;
use crate::wire::command::{Command, Commands, EndId};
use crate::wire::mail::ReceivingMail;
use crate::wire::mailbox::Mailbox;

/// What a receiving end tells its owner.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(in crate::wire) enum Received {
    Matched,
    Unmatched,
    /// The next message was sent then, before this receiver had joined.
    Latched(Instant),
    Message(Bytes),
    Flush,
}

#[derive(Debug)]
pub(in crate::wire) struct ReceivingEnd {
    id: EndId,
    commands: Commands,
    mail: Arc<Mailbox<ReceivingMail>>,
    key: String,
    max_size: u64,
    incoming: Option<Incoming>,
    /// The message to be told next, after its age.
    latched: Option<Bytes>,
    is_matched: bool,
    flush: bool,
    warned: bool,
}

impl ReceivingEnd {
    /// Receives what `host` sends on `key`. Closed at first.
    pub(in crate::wire) fn new(commands: &Commands, host: &str, key: &str, max_size: u64) -> Self {
        let id = EndId::next();
        // Twice what the sender may have on its way: it may have started over.
        let mail = Arc::new(Mailbox::new(2 * max_size.saturating_add(4 * WINDOW_BYTES)));
        commands.send(Command::AddReceiving {
            id,
            host: host.to_owned(),
            key: key.to_owned(),
            mail: Arc::clone(&mail),
        });
        ReceivingEnd {
            id,
            commands: commands.clone(),
            mail,
            key: key.to_owned(),
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
        self.id
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
            self.commands.send(Command::Acknowledge { id: self.id, ack });
        }
    }

    pub(in crate::wire) fn poll(&mut self, cx: &mut Context<'_>) -> Poll<Received> {
        loop {
            if let Some(message) = self.latched.take() {
                return Poll::Ready(Received::Message(message));
            }
            if std::mem::take(&mut self.flush) {
                return Poll::Ready(Received::Flush);
            }
            let Poll::Ready(mail) = self.mail.poll(cx) else { return Poll::Pending };
            let (header, payload) = match mail {
                ReceivingMail::Peer(peer) if peer.is_some() == self.is_matched => continue,
                ReceivingMail::Peer(peer) => {
                    self.is_matched = peer.is_some();
                    return Poll::Ready(if self.is_matched { Received::Matched } else { Received::Unmatched });
                }
                ReceivingMail::Arrived(header, payload) => (header, payload),
            };
            let Some(incoming) = &mut self.incoming else { continue };
            let outcome = incoming.accept(header, payload);
            if outcome.too_large && !std::mem::replace(&mut self.warned, true) {
                tracing::error!("`{}` carries a message of more than {} bytes; it is refused", self.key, self.max_size);
            }
            if let Some(ack) = outcome.answer {
                self.commands.send(Command::Acknowledge { id: self.id, ack });
            }
            self.flush |= outcome.flush;
            if let Some(message) = outcome.message {
                let Some(sent) = outcome.latched else { return Poll::Ready(Received::Message(message)) };
                self.latched = Some(message);
                return Poll::Ready(Received::Latched(sent));
            }
        }
    }
}

impl Drop for ReceivingEnd {
    fn drop(&mut self) {
        self.commands.send(Command::Remove { id: self.id });
    }
}
