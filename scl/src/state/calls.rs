//! The calls of a component's gates: whether they may be made, how they wait, and how they are ended.

use super::{ComponentState, Driven, runtime};
use crate::error::BlockingError;
use crate::service::Waiting;
use crate::sync::{AbortOnDrop, lock};
use std::sync::Weak;
use std::sync::atomic::Ordering;
use std::time::Duration;
use tokio::runtime::EnterGuard;

/// How long the component's runtime may stand still while a call waits for its own socket.
pub(super) const DIRECT_WAIT: Duration = Duration::from_millis(2);

/// Wakes the call that waits at one end of a gate.
pub(crate) trait WakeCall: Send + Sync {
    /// Wakes the call, if one waits.
    fn wake_call(&self);

    /// Returns true if a call waits. `futures`: whether a future that was polled counts, although it may have been
    /// abandoned.
    fn waits(&self, futures: bool) -> bool;
}

impl ComponentState {
    /// Fails if the component cannot be used any more, or not by this process.
    pub(crate) fn check(&self) -> Result<(), BlockingError> {
        if !self.is_inherited()
            && let Some(member) = &self.member
        {
            member.called();
        }
        self.check_silently()
    }

    /// As [`check`](Self::check), for a call that does not prove that the program is alive.
    pub(crate) fn check_silently(&self) -> Result<(), BlockingError> {
        if self.is_inherited() {
            return Err(BlockingError::Forked);
        }
        if self.calls_ended.load(Ordering::Acquire) {
            return Err(BlockingError::Closed);
        }
        if self.runtime_ended.load(Ordering::Acquire) { Err(BlockingError::RuntimeEnded) } else { Ok(()) }
    }

    /// Lets [`end_calls`](Self::end_calls) wake the calls that wait at an end.
    pub(crate) fn register_calls(&self, calls: Weak<dyn WakeCall>) {
        let mut waiting = lock(&self.waiting_calls);
        // Drop the entries of closed descriptors; the number of gates is bounded.
        waiting.retain(|calls| calls.strong_count() > 0);
        waiting.push(calls);
    }

    /// Ends all waiting calls of the gates with [`BlockingError::Closed`], and refuses later ones.
    ///
    /// A call that is about to wait sees the flag: it registers its waker first, under a lock that is taken here after
    /// the flag was set, and checks after that.
    pub(crate) fn end_calls(&self) {
        self.calls_ended.store(true, Ordering::SeqCst);
        lock(&self.waiting_calls).iter().filter_map(Weak::upgrade).for_each(|calls| calls.wake_call());
        self.ends().iter().for_each(|end| lock(end).wake_call());
        self.changes.report();
    }

    /// Returns true if a call waits that was not counted by [`waiting`](Self::waiting).
    pub(super) fn any_call_waits(&self) -> bool {
        // Without async, wakers do not count: blocking calls are counted by `waiting`, and leave their wakers behind
        // when they return.
        let futures = self.runtime.is_none();
        lock(&self.waiting_calls).iter().filter_map(Weak::upgrade).any(|calls| calls.waits(futures))
            || self.ends().iter().any(|end| futures && lock(end).call_waits())
    }

    /// Counts a call that waits until the returned value is dropped.
    pub(crate) fn waiting(&self) -> Option<Waiting<'_>> {
        self.member.as_ref().map(|member| member.wait())
    }

    /// Returns true if the gates are stopped: a stop was requested, and the program does not handle it itself or its
    /// grace period is over. Calls then stay pending or fail.
    pub(crate) fn is_stopped(&self) -> bool {
        crate::stop::gates_stopped()
    }

    /// Fails if a call that does not wait must not be made any more. A stop request takes precedence over the end of
    /// the component, which often follows it: programs treat the former as an orderly end, and may handle the latter as
    /// an error.
    pub(crate) fn may_proceed(&self) -> Result<(), BlockingError> {
        match self.check() {
            Err(BlockingError::Forked) => Err(BlockingError::Forked),
            _ if self.is_stopped() => Err(BlockingError::Stopped),
            usable => usable,
        }
    }

    /// Fails if the component cannot be closed by a call that blocks this thread. It can be closed after a stop
    /// request, and on a thread that is ending.
    pub(crate) fn may_close(&self) -> Result<(), BlockingError> {
        if self.is_inherited() {
            return Err(BlockingError::Forked);
        }
        match runtime::refuse_to_wait() {
            Err(BlockingError::ThreadEnding) => Ok(()),
            result => result,
        }
    }

    /// Fails if a call that may block must not be made any more, or not on this thread.
    pub(crate) fn may_block(&self) -> Result<(), BlockingError> {
        self.may_proceed()?;
        runtime::refuse_to_wait()
    }

    /// Waits on a plain thread until a future is ready or the gates are stopped.
    pub(crate) fn block_on<F: Future>(&self, future: F) -> Result<F::Output, BlockingError> {
        self.may_block()?;
        let _waiting = self.waiting();
        let future = crate::stop::until_stopped(future);
        match &self.runtime {
            Some(runtime) => runtime.block_on(future)?,
            None => runtime::park_until(future),
        }
    }

    /// Like [`block_on`](Self::block_on), but gives up after a given time and then returns `None`.
    pub(crate) fn block_on_for<F: Future>(
        &self,
        time: Duration,
        future: F,
    ) -> Result<Option<F::Output>, BlockingError> {
        self.may_block()?;
        let _waiting = self.waiting();
        let future = crate::stop::until_stopped(future);
        let done = match &self.runtime {
            Some(runtime) => runtime.block_on(async { tokio::time::timeout(time, future).await.ok() })?,
            None => runtime::park_until_or(time, future),
        };
        done.transpose()
    }

    /// Returns how long a blocking call may wait for its socket itself before it drives the component's own runtime,
    /// which avoids the runtime's event loop: the loop costs as much as everything else in a round trip. Returns `None`
    /// if the call must not wait that way.
    ///
    /// Messages that were held back to be written together are written first: the peer may have to answer them.
    pub(crate) fn direct_wait(&self) -> Option<Duration> {
        // Not while the component's thread drives the runtime: it would have to wait for the lock on the end, which
        // this call holds while it waits.
        self.runtime.as_ref().filter(|runtime| !runtime.is_driven())?;
        let unwritten = lock(&self.ends).iter().filter(|one| !lock(&one.end).write_out()).count();
        (unwritten == 0).then_some(DIRECT_WAIT)
    }

    /// Keeps the component's own runtime, if there is one, driven while no call drives it.
    pub(crate) fn drive_always(&self) -> Option<Driven> {
        self.runtime.as_ref().map(|runtime| runtime.drive_always())
    }

    /// Enters the runtime of the ends, to make a timer of it.
    pub(crate) fn enter(&self) -> EnterGuard<'_> {
        self.handle.enter()
    }

    /// Runs a task on the runtime of the ends, until it is done or dropped.
    pub(crate) fn spawn(&self, task: impl Future<Output = ()> + Send + 'static) -> AbortOnDrop {
        AbortOnDrop::spawn(&self.handle, task)
    }

    /// Gives the component's own runtime a turn if one is due, after a call that did not wait.
    pub(crate) fn take_turn(&self) {
        if let Some(runtime) = &self.runtime {
            runtime.take_turn();
        }
    }
}
