//! The async runtime of every process of a benchmark.

use tokio::runtime::{Builder, Runtime};

/// Starts a runtime that runs on the calling thread.
pub(crate) fn start_runtime() -> scl::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}
