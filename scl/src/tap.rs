//! A client of taps: everything that passes a gate, with number and time, as a stream of events.
//!
//! Every `pub`, `pull` and `rep` gate listens at its tap, whose name is in the component's plan
//! ([`GatePlan::tap`](crate::plan::GatePlan::tap)). Observers come and go; none of them delays the gate. The component keeps
//! up to 8192 messages and 16 MiB for an observer that does not read (a single longer message may always wait). Beyond that
//! it drops the oldest, which an observer sees as a gap in [`Observation::sequence`].
//!
//! # Example
//!
//! ```no_run
//! use scl::runtime_dir::RuntimeDir;
//! use scl::tap::{Observer, TapEvent};
//!
//! # #[tokio::main(flavor = "current_thread")]
//! # async fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let runtime_dir = RuntimeDir::existing(&|name| std::env::var_os(name))?.ok_or("nothing runs")?;
//! let system = runtime_dir.existing_system("rover")?.ok_or("`rover` does not run")?;
//! let mut observer = Observer::open(&system, "sensor.measurements.tap");
//! loop {
//!     if let TapEvent::Observed(seen) = observer.next().await {
//!         println!("message {} of {} bytes", seen.sequence, seen.payload.len());
//!     }
//! }
//! # }
//! ```

use crate::runtime_dir::SystemDir;
use crate::transport::zeromq::TapReader;
use bytes::Bytes;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};

/// Observes a gate at its tap. Connects by itself whenever the component runs, and again when it restarts.
pub struct Observer {
    reader: TapReader,
}

/// What happens at a tap.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TapEvent {
    /// The component shows this observer every message that passes the gate from now on. What passed shortly before this
    /// event may be observed, too.
    Connected,
    /// A message, request or reply.
    Observed(Observation),
    /// The component has closed, was killed, or cannot be understood. Follows [`Connected`](Self::Connected) only. The
    /// observer connects again by itself.
    Disconnected,
}

/// A message that passed a gate.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Observation {
    /// Its bytes, as the gate's codec encoded them.
    pub payload: Bytes,
    /// Its number at this gate, from 0 when the component was opened, also counted while nobody observes. A gap means
    /// that the observer did not read fast enough.
    pub sequence: u64,
    /// When the component sent or received it, in nanoseconds since 1970 (`CLOCK_REALTIME`).
    pub sent_ns: u64,
    /// When this observer read it, by the same clock.
    pub received_ns: u64,
    /// The number of the call that a request or reply belongs to; 0 for messages.
    pub call_id: u64,
    /// What it is.
    pub kind: ObservedKind,
}

/// What an observed message is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum ObservedKind {
    /// A message at a `pub` or `pull` gate.
    Message,
    /// A request at a `rep` gate.
    Request,
    /// A reply at a `rep` gate.
    Reply,
}

impl Observer {
    /// Observes the tap with this name in the folder of its system. The component need not run yet.
    ///
    /// # Panics
    /// If called outside of a tokio runtime with I/O and time. Any flavour will do.
    pub fn open(dir: &SystemDir, tap: &str) -> Self {
        Self { reader: TapReader::open(&Arc::new(dir.clone()), tap.to_owned()) }
    }

    /// Waits for the next event.
    ///
    /// # Cancel safety
    /// Cancel safe: no event is lost if this is dropped before it is ready.
    pub async fn next(&mut self) -> TapEvent {
        poll_fn(|cx| self.poll_next(cx)).await
    }

    /// [`next`](Self::next) as a poll, for several observers in one task.
    pub fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<TapEvent> {
        self.reader.poll_next(cx)
    }

    /// Number of messages so far that were not what a tap sends, and were passed over.
    pub fn rejected(&self) -> u64 {
        self.reader.rejected()
    }
}

impl std::fmt::Debug for Observer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Observer").field(&self.reader.endpoint()).finish()
    }
}
