//! What runs the calls of a benchmark: an async runtime, or a plain thread.

use tokio::runtime::{Builder, Runtime};

/// Starts a runtime that runs on the calling thread.
pub(crate) fn start_runtime() -> scl::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}

/// Runs the calls of a variant: on the runtime, or outside it if the calls block, as programs with such calls do.
pub(crate) fn run<T>(runtime: &Runtime, id: &str, calls: impl Future<Output = T>) -> T {
    let blocks = id.ends_with("-blocking") || ["libzmq", "iceoryx", "zenoh"].iter().any(|name| id.starts_with(name));
    if blocks { futures_executor::block_on(calls) } else { runtime.block_on(calls) }
}
