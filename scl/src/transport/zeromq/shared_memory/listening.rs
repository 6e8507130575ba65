//! What a listening end checks when it is opened, and offers to each of its peers.

use super::super::zmtp::ShmReady;
use crate::causes::text_with_causes;
use crate::runtime_dir::SystemDir;
use crate::transport::{Endpoint, TransportError};
use scl_shm::{Limits, ServiceName, SharedMemory};
use std::sync::Arc;

/// Shared memory, offered by a listening end.
pub(in super::super) struct Offer {
    /// Kept open as long as the end, so that leftovers of killed programs are removed only once, when the end is
    /// opened.
    _memory: Arc<SharedMemory>,
}

impl Offer {
    /// Opens shared memory for a listening end, and checks that there is enough of it.
    ///
    /// # Errors
    /// [`TransportError::Refused`], with what is needed, what there is, and what to change.
    pub(in super::super) fn open(dir: &SystemDir, endpoint: &Endpoint) -> Result<Self, TransportError> {
        let refused = |reason: String| TransportError::refused(&endpoint.name, &reason);
        let memory = SharedMemory::open(dir.folder());
        let memory = memory.map_err(|error| refused(format!("no shared memory: {}", text_with_causes(&error))))?;
        let limits = Limits { queue: endpoint.queue, longest: endpoint.longest };
        limits.check().map_err(|error| {
            refused(format!(
                "{error}, for `queue: {}` and messages of up to {} bytes; choose a smaller `max_size` or `queue` for the \
                 receiving gate, or give /dev/shm more (`mount -o remount,size=... /dev/shm`), or choose the transport `ipc`",
                endpoint.queue, endpoint.longest
            ))
        })?;
        Ok(Self { _memory: memory })
    }

    /// Returns what to offer to the next peer: a separate service.
    pub(in super::super) fn next(&self) -> ShmReady {
        ShmReady { service: Some(ServiceName::unique().0) }
    }
}
