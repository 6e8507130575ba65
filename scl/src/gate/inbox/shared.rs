//! An inbox that the calls of the program and the gate's background task share.

use super::Inbox;
use crate::figures::FigureSource;
use crate::gate::catch_up::Caller;
use crate::gate::io_waker::IoWaker;
use crate::gate::links::{Arrived, Links};
use crate::gate::tap::GateTap;
use crate::spec::GateSpec;
use crate::state::{ComponentState, WakeCall};
use crate::sync::{AbortOnDrop, lock, try_lock};
use crate::transport::Receiver;
use scl_fork::ProcessOwned;
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use std::task::{Context, Poll};
use tokio::runtime::Handle;

/// The inbox, its waker, and the task that drives it.
pub(in crate::gate) struct SharedInbox {
    inbox: ProcessOwned<Arc<Mutex<Inbox>>>,
    pub(in crate::gate) io: Arc<IoWaker>,
    _task: AbortOnDrop,
}

impl SharedInbox {
    /// Starts to receive. Needs a tokio runtime.
    pub(in crate::gate) fn new(
        spec: &GateSpec,
        links: Vec<Box<dyn Receiver>>,
        tap: GateTap,
        state: &ComponentState,
    ) -> Self {
        let io = Arc::new(IoWaker::default());
        state.register_calls(Arc::downgrade(&io) as _);
        let links = Links::new(spec, links, Arc::clone(&io), state.changes());
        let inbox = Arc::new(Mutex::new(Inbox::new(spec, links, tap)));
        state.register_receiving(Arc::downgrade(&inbox) as _);
        let task_io = Arc::clone(&io);
        let task = AbortOnDrop::drive(&Handle::current(), &inbox, move |inbox, cx| {
            task_io.set_task(cx.waker());
            if lock(inbox).drive() {
                task_io.wake_call();
            }
        });
        Self { inbox: ProcessOwned::new(inbox), io, _task: task }
    }

    /// Returns the next message, or registers the call and returns `Pending`.
    pub(in crate::gate) fn poll_next(&self, cx: &mut Context<'_>, caller: Caller) -> Poll<Arrived> {
        let mut inbox = lock(&self.inbox);
        let polled = inbox.poll_next(caller);
        inbox.report_ready();
        if polled.is_pending() {
            self.io.wait(cx.waker(), caller == Caller::Stream);
        }
        polled
    }

    /// Ready when a message waits; otherwise registers the call, which may vanish.
    pub(in crate::gate) fn poll_ready(&self, cx: &mut Context<'_>) -> Poll<()> {
        let mut inbox = lock(&self.inbox);
        inbox.take_in();
        inbox.report_ready();
        if inbox.queue.is_empty() {
            self.io.wait(cx.waker(), true);
            return Poll::Pending;
        }
        Poll::Ready(())
    }

    pub(in crate::gate) fn lock(&self) -> MutexGuard<'_, Inbox> {
        lock(&self.inbox)
    }

    pub(in crate::gate) fn figures(&self) -> FigureSource {
        let (inbox, in_wait) = (self.downgrade(), Arc::clone(&self.lock().in_wait));
        Box::new(move |figures| {
            let Some(inbox) = inbox.upgrade() else { return false };
            match try_lock(&inbox) {
                Some(inbox) => inbox.read_figures(figures),
                None => in_wait.copy_to(figures),
            }
            true
        })
    }

    pub(in crate::gate) fn downgrade(&self) -> Weak<Mutex<Inbox>> {
        Arc::downgrade(&self.inbox)
    }
}
