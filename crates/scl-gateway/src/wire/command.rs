//! Commands from the handles and the network library's callbacks to the thread that makes all calls of that library.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::mpsc;

use bytes::Bytes;
use tokio::sync::oneshot;
use zenoh::query::Query;

use super::header::{Ack, Header};
use super::mailbox::{Mailbox, ReceivingMail, SendingMail};

/// Identifies an end of a stream, a token or an announcement within this process.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct EndId(u64);

impl EndId {
    pub(super) fn next() -> Self {
        static LAST: AtomicU64 = AtomicU64::new(0);
        EndId(LAST.fetch_add(1, Ordering::Relaxed))
    }
}

/// What the thread has declared to the network. Dropping this value withdraws it.
#[derive(Debug)]
pub(super) struct Declared {
    id: EndId,
    commands: Commands,
}

impl Declared {
    /// Sends the command that declares it.
    pub(super) fn new(commands: &Commands, declare: impl FnOnce(EndId) -> Command) -> Self {
        let declared = Declared { id: EndId::next(), commands: commands.clone() };
        declared.send(declare);
        declared
    }

    pub(super) fn id(&self) -> EndId {
        self.id
    }

    /// Sends a command about it.
    pub(super) fn send(&self, command: impl FnOnce(EndId) -> Command) {
        self.commands.send(command(self.id));
    }
}

impl Drop for Declared {
    fn drop(&mut self) {
        self.send(|id| Command::Remove { id });
    }
}

pub(super) enum Command {
    /// Begins to send to a host, whose acknowledgements go into `mail`.
    AddSending { id: EndId, host: String, key: String, mail: Arc<Mailbox<SendingMail>> },
    /// Begins to receive from a host, whose messages go into `mail`.
    AddReceiving { id: EndId, host: String, key: String, mail: Arc<Mailbox<ReceivingMail>> },
    /// Ends an end, a token or an announcement.
    Remove { id: EndId },
    /// Queues a message, or a probe with an empty `message`, behind what this end has queued.
    Emit { id: EndId, header: Header, message: Bytes },
    /// Forgets what this end has queued.
    Clear { id: EndId },
    /// Sends an acknowledgement from a receiving end.
    Acknowledge { id: EndId, ack: Ack },
    /// Declares a token.
    Token { id: EndId, key: String },
    /// Announces a component of this host.
    Announce { id: EndId, key: String, content: Bytes },
    /// A neighbour wants a part of an announcement.
    Asked { id: EndId, query: Query },
    /// A neighbour's announcement appeared.
    Fetch { key: String },
    /// A neighbour's announcement disappeared.
    Forget { key: String },
    /// A part of a neighbour's announcement arrived, or did not.
    Part { key: String, part: Option<Part> },
    /// The gateway of a host appeared, was replaced or disappeared.
    Host { host: String, is_present: bool },
    /// A mark arrived from a neighbour, which waits for the echo.
    Mark { host: String, number: u64 },
    /// A neighbour has echoed this mark: it arrived there.
    Echo { host: String, number: u64 },
    /// Ends the thread, which then notifies `done`.
    Close { done: Option<oneshot::Sender<()>> },
}

/// A part of an announcement.
pub(super) struct Part {
    pub(super) offset: u64,
    pub(super) total: u64,
    pub(super) bytes: Bytes,
}

/// Sends commands to the thread; they are ignored once it has ended.
#[derive(Debug, Clone)]
pub(super) struct Commands(mpsc::Sender<Command>);

impl Commands {
    pub(super) fn new() -> (Commands, mpsc::Receiver<Command>) {
        let (sender, receiver) = mpsc::channel();
        (Commands(sender), receiver)
    }

    pub(super) fn send(&self, command: Command) {
        let _ = self.0.send(command);
    }
}
