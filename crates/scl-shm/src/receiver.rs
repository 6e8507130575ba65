//! The receiving end of a connection.

use crate::error::{ReceiveError, ShmError};
use crate::limits::{self, Limits};
use crate::loaned::Held;
use crate::node::SharedMemory;
use crate::service::{self, ServiceName};
use bytes::Bytes;
use iceoryx2::port::subscriber::Subscriber;
use iceoryx2::sample::Sample;
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use scl_fork::ProcessOwned;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The receiving end of a connection.
#[derive(Debug)]
pub struct SampleReceiver {
    port: Subscriber<Engine, [u8], ()>,
    limits: Limits,
    kept: Arc<AtomicUsize>,
    copied: u64,
    // Dropped last: the node must outlive the port.
    memory: Arc<SharedMemory>,
}

/// A received sample.
struct Received(ProcessOwned<Held<Sample<Engine, [u8], ()>>>);

impl AsRef<[u8]> for Received {
    fn as_ref(&self) -> &[u8] {
        self.0.sample.payload()
    }
}

impl SharedMemory {
    /// Opens the receiving end of a connection, and with it the connection's service. The sending end is opened next.
    ///
    /// # Errors
    /// [`ShmError`] if the service exists already or cannot be created.
    pub fn receiver(self: &Arc<Self>, name: ServiceName, limits: Limits) -> Result<SampleReceiver, ShmError> {
        limits::require(0)?;
        let service = service::create(&self.node(), name, &limits)?;
        let port = service
            .subscriber_builder()
            .create()
            .map_err(|error| ShmError::engine("create a receiving port", error))?;
        Ok(SampleReceiver { port, limits, kept: Arc::new(AtomicUsize::new(0)), copied: 0, memory: self.clone() })
    }
}

impl SampleReceiver {
    /// Maximum number of unacknowledged samples.
    pub fn in_flight(&self) -> usize {
        self.limits.in_flight()
    }

    /// Receives the sample that the peer has announced. Must be called exactly once for each announcement. The memory
    /// goes back to the peer when the returned bytes and all their clones are dropped. If too many samples are kept
    /// already, the bytes are a copy.
    ///
    /// # Errors
    /// [`ReceiveError`] if there is no such sample.
    pub fn receive(&mut self, length: u64) -> Result<Bytes, ReceiveError> {
        let sample = self.port.receive().map_err(|error| ReceiveError::Engine(format!("{error:?}")))?;
        let sample = sample.ok_or(ReceiveError::Missing)?;
        let sent = sample.payload().len() as u64;
        if sent != length {
            return Err(ReceiveError::Length { announced: length, sent });
        }
        if self.kept.load(Ordering::Relaxed) >= self.limits.kept() {
            self.copied += 1;
            return Ok(Bytes::copy_from_slice(sample.payload()));
        }
        Ok(Bytes::from_owner(Received(Held::new(sample, &self.kept, &self.memory))))
    }

    /// Number of samples that were copied because too many were kept.
    pub fn copied(&self) -> u64 {
        self.copied
    }
}
