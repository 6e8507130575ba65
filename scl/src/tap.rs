//! A client of taps: everything that passes a gate, with number and time, as a stream of events.
//!
//! Every `pub`, `pull` and `rep` gate listens at its tap, whose name is in the component's plan
//! ([`GatePlan::tap`](crate::plan::GatePlan::tap)). Observers come and go; none of them delays the gate. The component
//! keeps up to 8192 messages and 16 MiB for an observer that does not read (a single longer message may always wait).
//! Beyond that it drops the oldest, which an observer sees as a gap in [`Observation::sequence`].
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

pub use crate::observation::{Observation, ObservedKind, TapEvent};
use crate::runtime_dir::SystemDir;
use crate::transport::zeromq::TapReader;
use std::future::poll_fn;
use std::sync::Arc;
use std::task::{Context, Poll};

/// Observes a gate at its tap. Connects by itself whenever the component runs, and again when it restarts.
pub struct Observer {
    reader: TapReader,
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

    /// Like [`next`](Self::next), as a poll function, for several observers in one task.
    pub fn poll_next(&mut self, cx: &mut Context<'_>) -> Poll<TapEvent> {
        self.reader.poll_next(cx)
    }

    /// Returns the number of messages skipped so far because they were not valid messages of a tap.
    pub fn rejected(&self) -> u64 {
        self.reader.rejected()
    }
}

impl std::fmt::Debug for Observer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Observer").field(&self.reader.endpoint()).finish()
    }
}
