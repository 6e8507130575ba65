//! What runs the calls of a benchmark: an async runtime, or a plain thread.

use std::pin::pin;
use std::sync::Arc;
use std::task::{Context, Poll, Wake};
use std::thread::Thread;
use tokio::runtime::{Builder, Runtime};

/// Starts a runtime that runs on the calling thread.
pub(crate) fn start_runtime() -> scl::Result<Runtime> {
    Ok(Builder::new_current_thread().enable_all().build()?)
}

/// Runs the calls of a variant: on the runtime, or outside it if the calls block, as programs with such calls do.
pub(crate) fn run<T>(runtime: &Runtime, id: &str, calls: impl Future<Output = T>) -> T {
    let blocks = id.ends_with("-blocking") || ["libzmq", "iceoryx", "zenoh"].iter().any(|name| id.starts_with(name));
    if blocks { run_on_thread(calls) } else { runtime.block_on(calls) }
}

/// Runs calls that block, so that one poll is enough but for what waits for another process to start.
fn run_on_thread<T>(calls: impl Future<Output = T>) -> T {
    struct Unpark(Thread);
    impl Wake for Unpark {
        fn wake(self: Arc<Self>) {
            self.0.unpark();
        }
    }
    let waker = Arc::new(Unpark(std::thread::current())).into();
    let mut calls = pin!(calls);
    loop {
        match calls.as_mut().poll(&mut Context::from_waker(&waker)) {
            Poll::Ready(result) => return result,
            Poll::Pending => std::thread::park(),
        }
    }
}
