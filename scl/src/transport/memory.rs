//! Connections within one process, for tests of components and for systems that fit into one program.
//!
//! | file | what it knows |
//! |---|---|
//! | `pipe` | a bounded queue between two ends that notice each other's end |
//! | `meeting` | endpoints by name, and how the ends at one find each other |
//! | `flow` | the roles that only send or only receive |
//! | `call` | the roles that ask and answer |
//!
//! Nothing here needs a task, a thread or the operating system: an end that waits leaves its waker with whatever it
//! waits for, and whoever changes that wakes it, after it has let go of its lock.

mod call;
mod flow;
mod meeting;
mod pipe;

use super::{Answerer, Asker, Inlet, Outlet, Transport, TransportError};
use bytes::Bytes;
use meeting::Meeting;
use pipe::{Receiver, Sender};
use std::sync::Arc;

/// How many messages a connection holds that its reader has not taken.
const IN_FLIGHT: usize = 64;

/// A place in this process where ends meet; its clones are the same place.
///
/// Ends may be made in any order, in any tasks and threads. A connection holds at most 64 messages that its reader has
/// not taken; then `offer` gives the next one back. What was taken from an end that is dropped still arrives.
///
/// # Example
///
/// Two components of one test, without processes, files or sockets:
///
/// ```
/// use scl::OpenOptions;
/// use scl::transport::memory::Memory;
///
/// let place = Memory::new();
/// let for_sensor = OpenOptions::new().transport(place.clone());
/// let for_controller = OpenOptions::new().transport(place);
/// ```
#[derive(Clone, Default)]
pub struct Memory {
    place: Arc<Place>,
}

struct Place {
    publishing: Meeting<Sender<Bytes>, Receiver<Bytes>>,
    pulling: Meeting<Receiver<Bytes>, Sender<Bytes>>,
    replying: Meeting<call::Dialogue, call::Line>,
}

impl Memory {
    /// A place of its own: ends made at another one are not found here.
    pub fn new() -> Self {
        Self::default()
    }
}

impl Default for Place {
    fn default() -> Self {
        let pushed = || {
            let (sender, receiver) = pipe::pipe(IN_FLIGHT);
            (receiver, sender)
        };
        Self {
            publishing: Meeting::new(|| pipe::pipe(IN_FLIGHT)),
            pulling: Meeting::new(pushed),
            replying: Meeting::new(call::connect),
        }
    }
}

/// A listening end is refused while another one listens at its endpoint.
impl Transport for Memory {
    fn publish(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(Box::new(flow::Publishing::new(self.place.publishing.listen(endpoint)?)))
    }

    fn subscribe(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Ok(Box::new(flow::Subscribing::new(self.place.publishing.join(endpoint))))
    }

    fn push(&self, endpoint: &str) -> Result<Box<dyn Outlet>, TransportError> {
        Ok(Box::new(flow::Pushing::new(self.place.pulling.join(endpoint))))
    }

    fn pull(&self, endpoint: &str) -> Result<Box<dyn Inlet>, TransportError> {
        Ok(Box::new(flow::Pulling::new(self.place.pulling.listen(endpoint)?)))
    }

    fn request(&self, endpoint: &str) -> Result<Box<dyn Asker>, TransportError> {
        Ok(Box::new(call::Requesting::new(self.place.replying.join(endpoint))))
    }

    fn reply(&self, endpoint: &str) -> Result<Box<dyn Answerer>, TransportError> {
        Ok(Box::new(call::Replying::new(self.place.replying.listen(endpoint)?)))
    }
}

impl std::fmt::Debug for Memory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Memory").finish_non_exhaustive()
    }
}
