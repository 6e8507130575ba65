//! Memory that was lent to be filled and sent.

use crate::node::SharedMemory;
use iceoryx2::port::SendError;
use iceoryx2::sample_mut::SampleMut;
use iceoryx2::sample_mut_uninit::SampleMutUninit;
use iceoryx2::service::ipc_threadsafe::Service as Engine;
use scl_fork::ProcessOwned;
use std::mem::MaybeUninit;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub(crate) type Uninitialised = SampleMutUninit<Engine, [MaybeUninit<u8>], ()>;
pub(crate) type Sample = SampleMut<Engine, [u8], ()>;

/// A sample that is counted until it is given back, when this is dropped. A forked child does not give it back, because
/// the parent still uses it.
#[derive(Debug)]
pub(crate) struct Held<S> {
    pub(crate) sample: S,
    _counted: Counted,
    // Dropped last: the node must outlive the sample.
    _memory: Arc<SharedMemory>,
}

impl<S> Held<S> {
    pub(crate) fn new(sample: S, count: &Arc<AtomicUsize>, memory: &Arc<SharedMemory>) -> ProcessOwned<Self> {
        count.fetch_add(1, Ordering::Relaxed);
        ProcessOwned::new(Self { sample, _counted: Counted(count.clone()), _memory: memory.clone() })
    }
}

/// Counts a value until it is dropped.
#[derive(Debug)]
struct Counted(Arc<AtomicUsize>);

impl Drop for Counted {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

/// Memory lent by a [`SampleSender`](crate::SampleSender). Dropping it gives it back, except in a forked child: the
/// parent may still fill it.
///
/// Its initial content is unspecified: zeros or parts of older messages of the same connection.
pub struct LoanedSample {
    pub(crate) held: ProcessOwned<Held<Sample>>,
    /// The id of the port that lent it.
    pub(crate) sender: u128,
}

// SAFETY: A shared reference gives access to the payload for reading only (`as_slice`), and to nothing else of the
// sample. The payload is memory that nobody writes while it is lent, except through the exclusive reference of
// `as_mut_slice`. What `as_slice` reads beside it is behind the locks of `ipc_threadsafe`.
unsafe impl Sync for LoanedSample {}

impl LoanedSample {
    /// Sends the sample. Returns the number of receivers that it reached.
    pub(crate) fn send(self) -> Result<usize, SendError> {
        self.held.into_inner().sample.send()
    }

    /// The content.
    pub fn as_slice(&self) -> &[u8] {
        self.held.sample.payload()
    }

    /// The content, to be filled.
    pub fn as_mut_slice(&mut self) -> &mut [u8] {
        self.held.sample.payload_mut()
    }
}

// Not derived: that would read more of the sample than `Sync` allows.
impl std::fmt::Debug for LoanedSample {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("LoanedSample").field("length", &self.as_slice().len()).finish_non_exhaustive()
    }
}

/// Takes the memory as it is. Filling it with zeros would take as long as copying a message.
pub(crate) fn as_it_is(sample: Uninitialised) -> Sample {
    // SAFETY: The memory is a file that the operating system has mapped. It was filled with zeros by the operating
    // system or has been written since, so all of it is initialised; and every byte is a `u8`.
    unsafe { sample.assume_init() }
}
