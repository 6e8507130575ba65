//! The task that reports a component to a service manager.

use super::ComponentState;
use crate::service::Member;
use std::pin::pin;
use std::sync::{Arc, Weak};
use std::time::Duration;
use tokio::runtime::{Handle, RuntimeFlavor};
use tokio::time::timeout;

/// How often the task checks whether a component is ready: most changes wake it, but the opening or dropping of a gate
/// does not.
const UNTIL_READY: Duration = Duration::from_millis(50);
const ONCE_READY: Duration = Duration::from_secs(1);

/// Returns true if only calls to its gates prove that the program is alive: see [`Member`].
pub(super) fn follows_calls(owns_runtime: bool, handle: &Handle) -> bool {
    owns_runtime || handle.runtime_flavor() != RuntimeFlavor::CurrentThread
}

impl ComponentState {
    /// Starts to report to the service manager, if there is one.
    pub(crate) fn start_reporting(self: &Arc<Self>) {
        if let Some(member) = &self.member {
            let task = self.spawn(report(Arc::downgrade(self), Arc::clone(member)));
            let _started_once = self.reporting.set(task);
        }
    }
}

async fn report(state: Weak<ComponentState>, member: Arc<Member>) {
    while let Some(current) = state.upgrade() {
        let changes = current.changes();
        let mut changed = pin!(changes.next());
        // Subscribe before checking, so that no change is missed.
        changed.as_mut().enable();
        if let Some(missing) = current.monitor.missing() {
            member.report_missing(missing);
        }
        member.tick(|| current.any_call_waits());
        // Hold no reference while waiting, so that the component can be closed.
        drop(current);
        let pause = if member.was_ready() { ONCE_READY } else { UNTIL_READY };
        let pause = member.tick_period().map_or(pause, |period| period.min(pause));
        let _either = timeout(pause, changed).await;
    }
}
