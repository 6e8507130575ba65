//! What all gates of a component share.

use super::blocking::OwnedRuntime;
use super::site::Site;
use crate::error::{BlockingError, NotFlushed, OpenError};
use crate::gate::Outgoing;
use crate::place::Claim;
use crate::spec::ComponentSpec;
use crate::sync::{AbortOnDrop, lock};
use std::future::poll_fn;
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use std::time::{Duration, Instant};

/// The part of a component that lives as long as any of its gates.
pub struct Core {
    spec: &'static ComponentSpec,
    connections: Mutex<Vec<Connection>>,
    announcement: Mutex<Option<Claim>>,
    runtime: Option<Arc<OwnedRuntime>>,
    /// Let go last: as soon as the name is free, another program may play this component.
    site: Site,
}

/// A sending connection and the task that drives it.
struct Connection {
    outgoing: Arc<Mutex<Outgoing>>,
    _task: AbortOnDrop,
}

impl Core {
    pub(super) fn new(spec: &'static ComponentSpec, site: Site, runtime: Option<Arc<OwnedRuntime>>) -> Self {
        Self { spec, connections: Mutex::default(), announcement: Mutex::default(), runtime, site }
    }

    pub(crate) fn spec(&self) -> &'static ComponentSpec {
        self.spec
    }

    /// Tells others that the component is open, until it is closed.
    pub(super) fn announce(&self) -> Result<(), OpenError> {
        *lock(&self.announcement) = self.site.announce(self.spec)?;
        Ok(())
    }

    /// Keeps a connection moving, whether its gate is used or not.
    pub(super) fn drive(&self, outgoing: Outgoing) -> Arc<Mutex<Outgoing>> {
        let outgoing = Arc::new(Mutex::new(outgoing));
        // Weak, so that the end is gone with its gate, and not only when the runtime gets to the task's end.
        let driven = Arc::downgrade(&outgoing);
        let task = tokio::spawn(poll_fn(move |cx| match driven.upgrade() {
            Some(outgoing) => {
                lock(&outgoing).drive(cx);
                Poll::Pending
            }
            None => Poll::Ready(()),
        }));
        let task = AbortOnDrop(task.abort_handle());
        lock(&self.connections).push(Connection { outgoing: Arc::clone(&outgoing), _task: task });
        outgoing
    }

    /// Whether the component was opened for a program without async.
    pub(crate) fn owns_runtime(&self) -> bool {
        self.runtime.is_some()
    }

    /// Waits for a future from a plain thread.
    pub(crate) fn block_on<F: Future>(&self, future: F) -> Result<F::Output, BlockingError> {
        match &self.runtime {
            Some(runtime) => runtime.block_on(future),
            None => super::blocking::wait_beside(future),
        }
    }

    /// Does something, and runs what the transport leaves to tasks of its own: nobody else does between two calls of a
    /// program without async.
    pub(crate) fn with_a_turn<R>(&self, act: impl FnOnce() -> R) -> R {
        match &self.runtime {
            Some(runtime) => runtime.act(act),
            None => act(),
        }
    }

    /// The end of a program without async: hands over what connected peers still take, also when it was told to stop.
    pub(super) fn flush_blocking(&self, timeout: Duration) -> Result<(), NotFlushed> {
        match &self.runtime {
            Some(runtime) => runtime.drive_until(self.flush(timeout)).unwrap_or(Ok(())),
            None => Ok(()),
        }
    }

    /// Waits until connected peers have taken everything, at most for a given time.
    pub(super) async fn flush(&self, timeout: Duration) -> Result<(), NotFlushed> {
        let started = Instant::now();
        // The library writes replies in tasks of its own, which have not run yet when the last reply was just given.
        for _ in 0..3 {
            tokio::task::yield_now().await;
        }
        let flushed = poll_fn(|cx| self.poll_flushed(cx));
        match tokio::time::timeout(timeout, flushed).await {
            Ok(()) => Ok(()),
            Err(_elapsed) => {
                let waiting = lock(&self.connections).iter().map(|one| lock(&one.outgoing).waiting()).sum();
                Err(NotFlushed { component: self.spec.name, waiting, waited: started.elapsed() })
            }
        }
    }

    fn poll_flushed(&self, cx: &mut Context<'_>) -> Poll<()> {
        for connection in &*lock(&self.connections) {
            let mut outgoing = lock(&connection.outgoing);
            if !outgoing.is_flushed() {
                outgoing.wake_when_flushed(cx.waker());
                return Poll::Pending;
            }
        }
        Poll::Ready(())
    }
}

/// Hands over what connected peers take at once.
impl Drop for Core {
    fn drop(&mut self) {
        for connection in &*lock(&self.connections) {
            lock(&connection.outgoing).drive(&mut Context::from_waker(Waker::noop()));
        }
    }
}

impl std::fmt::Debug for Core {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Core").field(&self.spec.name).finish()
    }
}
