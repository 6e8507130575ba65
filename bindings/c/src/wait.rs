//! Waiting for several gates, in a call or in an event loop.

use crate::border::{self, Wait};
use crate::component::{self, scl_component};
use crate::error::Failure;
use crate::gate::{self, OpenGate, scl_gate};
use crate::receive::NOTHING;
use crate::registry::Locked;
use crate::status::*;
use scl::ReceivingGate;
use scl::untyped::{Component, WaitError};
use std::ffi::c_int;
use std::os::fd::AsRawFd;
use std::time::Duration;

/// Maximum number of gates that one call waits for: one bit each.
const MOST: usize = 64;

/// Waits until at least one of `count` gates of a component has a message or a request, and sets the bits of those that
/// have in `*ready`: bit 0 for `gates[0]`. It takes nothing; scl_recv or scl_take_request of these gates then do not
/// wait. A timeout of 0 only looks, a negative one waits without limit.
///
/// At most 64 gates, of the kinds `sub`, `pull` and `rep`. No other thread may use any of them during the call.
///
/// Errors: SCL_NOTHING (timeout 0), SCL_TIMEOUT, SCL_KIND, SCL_STOPPED, SCL_CLOSED, SCL_BUSY (also if a gate is given
/// twice), SCL_HANDLE. `*ready` is 0 then.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_wait(
    component: *mut scl_component,
    gates: *const *mut scl_gate,
    count: usize,
    timeout_ns: i64,
    ready: *mut u64,
) -> scl_status {
    border::status(|| {
        // SAFETY: guaranteed by the caller; NULL is refused.
        let ready = unsafe { border::result(ready, "ready") }?;
        *ready = 0;
        // SAFETY: guaranteed by the caller; NULL and invalid counts are refused.
        let gates = unsafe { list(gates, count) }?;
        let opened = component::find(component)?;
        let mut locked = gates.iter().map(|gate| gate::lock(*gate)).collect::<Result<Vec<_>, _>>()?;
        if let Some(index) = gates.iter().position(|gate| !opened.owns(*gate)) {
            return Err(Failure::argument(format!("`gates[{index}]` is not a gate of this component")));
        }
        *ready = match kept(&locked) {
            0 => opened.with(|component| wait(component, &mut locked, Wait::of(timeout_ns)))?,
            kept => kept,
        };
        Ok(())
    })
}

/// Returns a file descriptor for `poll`, `epoll` and event loops, or -1; `scl_error` then says why.
///
/// It is readable while any gate of the component has a message or a request, until all were taken with a timeout of 0,
/// and from a stop request on. It is level-triggered. It belongs to the component: do not read from it, write to it or
/// close it. Further calls return the same descriptor. From the first call on, a thread of the library does the
/// component's input and output, so that nothing is missed while no call is under way.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn scl_fd(component: *mut scl_component) -> c_int {
    border::value(|| Ok(component::find(component)?.readiness()?.as_raw_fd())).unwrap_or(-1)
}

/// Returns the handles in an array. NULL and invalid counts are refused.
///
/// # Safety
/// `gates` is NULL or points to `count` handles.
unsafe fn list<'a>(gates: *const *mut scl_gate, count: usize) -> Result<&'a [*mut scl_gate], Failure> {
    if count == 0 || count > MOST {
        return Err(Failure::argument(format!("`count` is {count}; a call waits for 1 to {MOST} gates")));
    }
    if gates.is_null() {
        return Err(border::null("gates"));
    }
    // SAFETY: not NULL, and at most `MOST` handles; the caller guarantees the rest.
    Ok(unsafe { std::slice::from_raw_parts(gates, count) })
}

/// Returns the bits of the gates that keep a message because the buffer of `scl_recv_into` was too small for it.
fn kept(gates: &[Locked<'_, OpenGate>]) -> u64 {
    let kept = gates.iter().enumerate().filter(|(_, gate)| gate.kept.is_some());
    kept.fold(0, |bits, (index, _)| bits | 1 << index)
}

fn wait(component: &Component, gates: &mut [Locked<'_, OpenGate>], wait: Wait) -> Result<u64, Failure> {
    let other_kind = gates.iter_mut().position(|gate| gate.gate.receiving().is_none());
    if let Some(index) = other_kind {
        return Err(gates[index].wrong_kind("scl_wait"));
    }
    let mut receiving: Vec<&mut dyn ReceivingGate> =
        gates.iter_mut().filter_map(|gate| gate.gate.receiving()).collect();
    match (component.wait_any_blocking(&mut receiving, wait.limit()), wait) {
        (Ok(ready), _) => Ok(ready.into_iter().fold(0, |bits, index| bits | 1 << index)),
        (Err(WaitError::Timeout { waited: Duration::ZERO, .. }), Wait::No) => Err(NOTHING),
        (Err(error), _) => Err(error.into()),
    }
}
