//! Waiting for several gates at once.

use crate::claimed::Borrowed;
use crate::failure::Failure;
use crate::gate::Gate;
use crate::limit::Limit;
use crate::shared::Shared;
use crate::waiting::wait;
use pyo3::prelude::*;
use scl::ReceivingGate;
use std::future::poll_fn;
use std::task::{Context, Poll};

/// Waits until at least one gate has something, and returns the indices of those that have; none when the time is over.
pub(crate) fn wait_any(py: Python<'_>, limit: Limit, shared: &Shared, gates: &[&Gate]) -> PyResult<Vec<usize>> {
    let mut borrowed = Vec::new();
    for gate in gates {
        let mut own = gate.claim()?.borrow().map_err(|unusable| gate.unusable(unusable))?;
        if own.gate().is_none_or(|gate| gate.receiving().is_none()) {
            return Ok(gate.has_no("recv")?);
        }
        borrowed.push(own);
    }
    let ready = wait(py, limit, shared, |within| {
        match shared.driver.wait_for(poll_fn(|cx| poll_any(&mut borrowed, cx)), within)? {
            Some(ready) => ready.map(Some),
            None => Ok(None),
        }
    })?;
    Ok(ready.unwrap_or_default())
}

/// Polls all gates, so that each of them wakes the call.
fn poll_any(gates: &mut [Borrowed<'_>], cx: &mut Context<'_>) -> Poll<Result<Vec<usize>, Failure>> {
    let mut ready = Vec::new();
    for (index, gate) in gates.iter_mut().enumerate() {
        let gate: Option<&mut dyn ReceivingGate> = gate.gate().and_then(|gate| gate.receiving());
        match gate.map(|gate| gate.poll_ready(cx)) {
            Some(Poll::Ready(Ok(()))) => ready.push(index),
            Some(Poll::Ready(Err(error))) => return Poll::Ready(Err(error.into())),
            _ => {}
        }
    }
    if ready.is_empty() { Poll::Pending } else { Poll::Ready(Ok(ready)) }
}
