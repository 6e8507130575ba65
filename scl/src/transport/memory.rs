//! Connections within one process, for tests of components and for systems that fit into one program.
//!
//! | file | contents |
//! |---|---|
//! | `pipe` | a bounded queue between two ends |
//! | `switchboard` | endpoints by name, and connecting the ends there |
//! | `send` | the sending ends: publish and push |
//! | `lend` | memory that links lend |
//! | `receive` | the receiving ends: subscribe and pull |
//! | `catch_up` | waiting without a runtime for what senders hold back |
//! | `request_reply` | the ends for requests and replies |
//!
//! No end needs a task, a thread or the operating system: an end that has to wait stores its waker where the other end
//! finds it, and the other end wakes it after releasing its lock.

mod catch_up;
mod lend;
mod pipe;
mod receive;
mod request_reply;
mod send;
mod switchboard;
#[cfg(test)]
mod tests;

use super::{Endpoint, Guarantees, Receiver, Replier, Requester, Sender, Transport, TransportError};
use bytes::Bytes;
use pipe::{PipeReader, PipeWriter, pipe_of};
use request_reply::{ToReplier, ToRequester};
use std::sync::Arc;
use switchboard::Switchboard;

/// Maximum number of messages of a connection that the receiver has not taken.
const IN_FLIGHT: usize = 64;
/// The same if the receiver wants only the newest message: a sender can still replace a message that it cannot send
/// yet.
const IN_FLIGHT_NEWEST: usize = 1;
/// The same in a unit test: more than a test sends before the component receives.
const IN_FLIGHT_NEWEST_OF_TEST: usize = 1000;

/// Connects ends within this process. Clones share their endpoints; separate values share nothing.
///
/// Ends may be opened in any order, in any task or thread. A connection holds at most 64 messages that the receiver has
/// not taken (1 for an end with [`Endpoint::newest_only`]), then [`Link::send`](super::Link::send) returns the next
/// one. What a link has accepted still arrives after the link is dropped. Links lend memory of any length, which the
/// receiver gets without a copy.
///
/// A subscriber whose publisher drops the connection and goes on listening has been replaced by another subscriber. It
/// stays unconnected until a new publisher listens; otherwise the two subscribers would replace each other forever.
///
/// # Example
///
/// Two components of one test, without processes, files or sockets:
///
/// ```
/// use scl::OpenOptions;
/// use scl::transport::memory::Memory;
///
/// let memory = Memory::new();
/// let for_sensor = OpenOptions::new().transport(memory.clone());
/// let for_controller = OpenOptions::new().transport(memory);
/// ```
#[derive(Clone)]
pub struct Memory {
    publishing: Arc<Switchboard<PipeWriter<Bytes>, PipeReader<Bytes>>>,
    pulling: Arc<Switchboard<PipeReader<Bytes>, PipeWriter<Bytes>>>,
    replying: Arc<Switchboard<ToRequester, ToReplier>>,
}

impl Memory {
    /// Creates a transport without any ends.
    pub fn new() -> Self {
        Self::holding::<IN_FLIGHT_NEWEST>()
    }

    /// Creates a transport for unit tests with threads: an end that wants only the newest message can receive at once
    /// what was sent to it, without waiting for the sender's thread to replace what it could not send.
    pub(crate) fn of_test() -> Self {
        Self::holding::<IN_FLIGHT_NEWEST_OF_TEST>()
    }

    /// `NEWEST`: how many messages may be in flight to an end that wants only the newest one.
    fn holding<const NEWEST: usize>() -> Self {
        // Only the receiving end decides how much is in flight.
        let publishing = Switchboard::new(|listener, connector| pipe_of(in_flight::<NEWEST>(connector), listener));
        let pulling = Switchboard::new(|listener, connector| {
            let (writer, reader) = pipe_of(in_flight::<NEWEST>(listener), connector);
            (reader, writer)
        });
        Self { publishing, pulling, replying: Switchboard::new(request_reply::connect) }
    }
}

/// Returns how many messages a connection to this receiving end may hold.
fn in_flight<const NEWEST: usize>(receiving: &Endpoint) -> usize {
    if receiving.newest_only { NEWEST } else { IN_FLIGHT }
}

impl Default for Memory {
    fn default() -> Self {
        Self::new()
    }
}

/// A second listening end at one endpoint is refused.
impl Transport for Memory {
    fn guarantees(&self) -> Guarantees {
        Guarantees::ALL
    }

    fn publish(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(self.publishing.listen(endpoint)?))
    }

    fn subscribe(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(receive::Subscriber::new(self.publishing.connect(endpoint))))
    }

    fn push(&self, endpoint: &Endpoint) -> Result<Box<dyn Sender>, TransportError> {
        Ok(Box::new(send::Pusher::new(self.pulling.connect(endpoint))))
    }

    fn pull(&self, endpoint: &Endpoint) -> Result<Box<dyn Receiver>, TransportError> {
        Ok(Box::new(receive::Puller::new(self.pulling.listen(endpoint)?)))
    }

    fn request(&self, endpoint: &Endpoint) -> Result<Box<dyn Requester>, TransportError> {
        Ok(Box::new(request_reply::MemoryRequester::new(self.replying.connect(endpoint))))
    }

    fn reply(&self, endpoint: &Endpoint) -> Result<Box<dyn Replier>, TransportError> {
        Ok(Box::new(request_reply::MemoryReplier::new(self.replying.listen(endpoint)?)))
    }
}

impl std::fmt::Debug for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Memory").finish_non_exhaustive()
    }
}
