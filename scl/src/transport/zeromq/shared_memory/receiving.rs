//! The receiving side of a connection.

use super::super::zmtp::{PeerReady, ProtocolError};
use crate::causes::text_with_causes;
use crate::runtime_dir::SystemDir;
use crate::transport::Endpoint;
use bytes::Bytes;
use scl_shm::{Limits, SampleReceiver, ServiceName, SharedMemory};

/// Shared memory at the receiving side.
pub(in super::super) struct Arriving {
    receiver: Option<SampleReceiver>,
    /// The longest sample that is accepted.
    max_size: u64,
    /// Number of samples received, and of those that are not acknowledged.
    received: u64,
    unacknowledged: usize,
}

impl Arriving {
    /// Opens shared memory if both ends have agreed on it. The peer has to be told if it [is open](Self::is_open).
    pub(in super::super) fn open(dir: &SystemDir, peer: &PeerReady, endpoint: &Endpoint) -> Self {
        let limits = Limits { queue: endpoint.queue, longest: endpoint.longest };
        let receiver = peer.service.and_then(|service| {
            SharedMemory::open(dir.folder())
                .and_then(|memory| memory.receiver(ServiceName(service), limits))
                .inspect_err(|error| {
                    let reason = text_with_causes(error);
                    tracing::warn!(endpoint = %endpoint.name, "cannot share memory with a sending peer: {reason}");
                })
                .ok()
        });
        Self { receiver, max_size: endpoint.max_size as u64, received: 0, unacknowledged: 0 }
    }

    pub(in super::super) fn is_open(&self) -> bool {
        self.receiver.is_some()
    }

    /// Returns the sample that the peer has announced, and whether half of the window waits to be acknowledged.
    pub(in super::super) fn receive(&mut self, sequence: u64, length: u64) -> Result<(Bytes, bool), ProtocolError> {
        let wrong = |reason: &dyn ToString| ProtocolError::Sample(reason.to_string());
        let Some(receiver) = &mut self.receiver else {
            return Err(wrong(&"the peer sent a sample without shared memory"));
        };
        if length > self.max_size {
            return Err(ProtocolError::TooLong { announced: length, limit: self.max_size });
        }
        self.received += 1;
        if sequence != self.received {
            return Err(wrong(&format!("the peer announced sample {sequence} instead of {}", self.received)));
        }
        let copied = receiver.copied();
        let message = receiver.receive(length).map_err(|error| wrong(&error))?;
        if receiver.copied() > copied && receiver.copied().is_power_of_two() {
            let count = receiver.copied();
            tracing::warn!("copying messages from shared memory, {count} so far: the program holds too many of them");
        }
        self.unacknowledged += 1;
        Ok((message, 2 * self.unacknowledged >= receiver.in_flight()))
    }

    pub(in super::super) fn acknowledged(&mut self) {
        self.unacknowledged = 0;
    }
}
