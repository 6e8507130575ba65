//! The socket where a running component can be asked to change its live parameters.

use super::wire;
use crate::error::OpenError;
use crate::state::ComponentState;
use crate::sync::{AbortOnDrop, await_other_users, lock};
use crate::transport::{Endpoint, Replier, Transport};
use std::sync::{Arc, Mutex};
use std::task::{Context, Poll};
use tokio::runtime::Handle;

/// How many requests are answered before other tasks have a turn.
const AT_ONCE: usize = 16;

/// Answers requests for a component, on its runtime.
pub(crate) struct Setter {
    end: Arc<Mutex<Box<dyn Replier>>>,
    /// `None` once dropped.
    task: Option<AbortOnDrop>,
}

impl Setter {
    /// Opens the socket. Must be called inside the component's runtime.
    pub(crate) fn open(transport: &dyn Transport, state: &Arc<ComponentState>) -> Result<Self, OpenError> {
        let component = state.spec.name;
        let end = transport.reply(&Endpoint::accepting(wire::socket(component), wire::LIMIT));
        let end = end.map_err(|source| OpenError::SetSocket { component, source })?;
        let (end, state) = (Arc::new(Mutex::new(end)), Arc::downgrade(state));
        let answer = move |end: &Mutex<Box<dyn Replier>>, cx: &mut Context<'_>| {
            for _ in 0..AT_ONCE {
                let Poll::Ready(request) = lock(end).poll_request(cx) else { return };
                let Some(state) = state.upgrade() else { return };
                let answer = wire::answer(&state, &request.body);
                // One who has gone needs no answer.
                let _gone = request.path.reply(&request.envelope, answer);
            }
            cx.waker().wake_by_ref();
        };
        let task = AbortOnDrop::drive(&Handle::current(), &end, answer);
        Ok(Self { end, task: Some(task) })
    }
}

/// Closes the socket here, so that another process may open it when this returns.
impl Drop for Setter {
    fn drop(&mut self) {
        drop(self.task.take());
        await_other_users(&self.end);
    }
}
