//! The sending end of a connection: lending memory and sending it.

use crate::committed::Committed;
use crate::error::{LoanError, SendError, ShmError};
use crate::limits::{self, Limits};
use crate::loaned::{self, Held, LoanedSample, Uninitialised};
use crate::node::SharedMemory;
use crate::service::{self, ServiceName};
use iceoryx2::port::publisher::Publisher;
use iceoryx2::port::{BackpressureAction, LoanError as EngineLoanError};
use iceoryx2::prelude::{AllocationStrategy, BackpressureStrategy};
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The sending end of a connection.
#[derive(Debug)]
pub struct SampleSender {
    port: Publisher<Engine, [u8], ()>,
    id: u128,
    limits: Limits,
    /// The longest message for which the current segment is known to have room.
    longest: usize,
    committed: Committed,
    loans: Arc<AtomicUsize>,
    // Dropped last: the node must outlive the port.
    memory: Arc<SharedMemory>,
}

impl SharedMemory {
    /// Opens the sending end of a connection whose receiving end is open. Messages of up to `expected` bytes need no
    /// second segment.
    ///
    /// # Errors
    /// [`ShmError`] if the service does not exist, or is not one that [`receiver`](Self::receiver) has created.
    pub fn sender(self: &Arc<Self>, name: ServiceName, expected: usize) -> Result<SampleSender, ShmError> {
        limits::require(0)?;
        let (service, limits) = service::open(&self.node(), name)?;
        let port = service
            .publisher_builder()
            .max_loaned_samples(limits.loans())
            .initial_max_slice_len(expected.max(1))
            .allocation_strategy(AllocationStrategy::PowerOfTwo)
            .backpressure_strategy(BackpressureStrategy::DiscardData)
            // Credits keep the buffer from filling up. If a peer violates them, the loss must not go unnoticed.
            .set_backpressure_handler(|_| BackpressureAction::DiscardDataAndFail)
            .create()
            .map_err(|error| ShmError::engine("create a sending port", error))?;
        let id = port.id().value();
        let (committed, loans) = (Committed::default(), Arc::new(AtomicUsize::new(0)));
        Ok(SampleSender { port, id, limits, longest: 0, committed, loans, memory: self.clone() })
    }
}

impl SampleSender {
    /// Maximum number of unacknowledged samples. Samples that are sent beyond it are lost.
    pub fn in_flight(&self) -> usize {
        self.limits.in_flight()
    }

    /// Lends memory to be filled. One loan is reserved for [`copy`](Self::copy).
    ///
    /// # Errors
    /// [`LoanError`] if no memory can be lent now.
    pub fn loan(&mut self, length: usize) -> Result<LoanedSample, LoanError> {
        if self.loans.load(Ordering::Relaxed) + 1 >= self.limits.loans() {
            return Err(LoanError::TooMany);
        }
        let sample = self.lend(length)?;
        Ok(self.count(loaned::as_it_is(sample)))
    }

    /// Lends memory with a copy of a message.
    ///
    /// # Errors
    /// [`LoanError`] if no memory can be lent now.
    pub fn copy(&mut self, message: &[u8]) -> Result<LoanedSample, LoanError> {
        let sample = self.lend(message.len())?;
        Ok(self.count(sample.write_from_slice(message)))
    }

    fn count(&self, sample: loaned::Sample) -> LoanedSample {
        LoanedSample { held: Held::new(sample, &self.loans, &self.memory), sender: self.id }
    }

    fn lend(&mut self, length: usize) -> Result<Uninitialised, LoanError> {
        if length > self.longest {
            // The engine may allocate a new segment, in which every sample may become this long.
            Limits { longest: length, ..self.limits }.check()?;
            self.committed.grown();
        } else {
            // The engine writes its header before the memory below can be reserved.
            limits::require(0)?;
        }
        let sample = self.port.loan_slice_uninit(length).map_err(|error| match error {
            EngineLoanError::ExceedsMaxLoans => LoanError::TooMany,
            error => LoanError::Engine(format!("{error:?}")),
        })?;
        self.longest = self.longest.max(length);
        self.committed.reserve(sample.payload().as_ptr().addr(), length)?;
        Ok(sample)
    }

    /// Returns true if this end has lent the sample.
    pub fn has_lent(&self, sample: &LoanedSample) -> bool {
        sample.sender == self.id
    }

    /// Sends a sample that this end has lent. The caller has to announce it to the receiving end.
    ///
    /// # Errors
    /// [`SendError`]; the sample is gone.
    pub fn send(&mut self, sample: LoanedSample) -> Result<(), SendError> {
        match sample.send() {
            Ok(1..) => Ok(()),
            Ok(0) => Err(SendError::NoReceiver),
            Err(error) => Err(SendError::Engine(format!("{error:?}"))),
        }
    }
}
