//! A connection that is dialled again whenever it is lost: a task dials, the end that uses the socket says when it is
//! lost.

use super::dial::{Dialled, Dials, dial};
use crate::place::SystemDir;
use crate::sync::{AbortOnDrop, lock};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll, Waker};
use tokio::sync::Notify;

/// One end of a connection that comes back.
pub(super) struct Line<S: Dials> {
    shared: Arc<Shared<S>>,
    current: Option<Dialled<S>>,
    _task: AbortOnDrop,
}

struct Shared<S: Dials> {
    slot: Mutex<Slot<S>>,
    lost: Notify,
}

struct Slot<S: Dials> {
    arrived: Option<Dialled<S>>,
    waiting: Option<Waker>,
    /// Whether a socket is in the slot or in use.
    connected: bool,
}

impl<S: Dials> Line<S> {
    /// Dials an endpoint, and again whenever the connection is lost.
    pub(super) fn open(place: &Arc<SystemDir>, endpoint: &str) -> Self {
        let slot = Mutex::new(Slot { arrived: None, waiting: None, connected: false });
        let shared = Arc::new(Shared { slot, lost: Notify::new() });
        let task = tokio::spawn(dial_for_ever(Arc::clone(&shared), Arc::clone(place), endpoint.to_owned()));
        Self { shared, current: None, _task: AbortOnDrop(task.abort_handle()) }
    }

    /// The connection, as soon as there is one.
    pub(super) fn poll_dialled(&mut self, cx: &mut Context<'_>) -> Poll<&mut Dialled<S>> {
        if self.current.is_none() {
            let mut slot = lock(&self.shared.slot);
            self.current = slot.arrived.take();
            if self.current.is_none() {
                slot.waiting = Some(cx.waker().clone());
            }
        }
        self.current.as_mut().map_or(Poll::Pending, Poll::Ready)
    }

    /// The connection, if there is one; nobody is woken for it.
    pub(super) fn dialled(&mut self) -> Option<&mut Dialled<S>> {
        if self.current.is_none() {
            self.current = lock(&self.shared.slot).arrived.take();
        }
        self.current.as_mut()
    }

    /// Gives up the socket; the task dials again.
    pub(super) fn lost(&mut self) {
        self.current = None;
        lock(&self.shared.slot).connected = false;
        self.shared.lost.notify_one();
    }

    pub(super) fn is_connected(&self) -> bool {
        lock(&self.shared.slot).connected
    }
}

async fn dial_for_ever<S: Dials>(shared: Arc<Shared<S>>, place: Arc<SystemDir>, endpoint: String) {
    loop {
        let dialled = dial::<S>(&place, &endpoint).await;
        {
            let mut slot = lock(&shared.slot);
            slot.arrived = Some(dialled);
            slot.connected = true;
            if let Some(waker) = slot.waiting.take() {
                waker.wake();
            }
        }
        shared.lost.notified().await;
    }
}
