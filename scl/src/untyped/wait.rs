//! Waiting for several gates at once.

use super::{Component, WaitError};
use crate::error::GateName;
use crate::gate::ReceivingGate;
use std::future::poll_fn;
use std::task::{Context, Poll};
use std::time::Duration;

impl Component {
    /// Waits until at least one of several gates has a message or a request, and returns the indices of those that have
    /// one. It does not take any: `try_recv` of such a gate then returns a message.
    ///
    /// # Errors
    /// [`WaitError::Recv`] if a gate cannot be used any more, also after a stop request.
    ///
    /// # Cancel safety
    /// Cancel safe.
    pub async fn wait_any(&self, gates: &mut [&mut dyn ReceivingGate]) -> Result<Vec<usize>, WaitError> {
        poll_fn(|cx| poll_any(gates, cx)).await
    }

    /// [`wait_any`](Self::wait_any) from a plain thread, with a time limit, which is exact to a millisecond.
    ///
    /// ```
    /// use scl::plan::SystemPlan;
    /// use scl::untyped::Component;
    /// use std::time::Duration;
    /// # fn main() -> scl::Result<()> {
    /// # let transport = scl::transport::memory::Memory::new();
    /// # let options = || scl::OpenOptions::new().transport(transport.clone());
    ///
    /// let system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
    /// let mut controller = Component::open_blocking_with(system.component("controller")?, options())?;
    /// let (mut sensor, mut commands) = (controller.subscriber("sensor")?, controller.replier("commands")?);
    /// # let mut peer = Component::open_blocking_with(system.component("sensor")?, options())?;
    /// # let mut sends = peer.publisher("measurements")?;
    /// # sends.send_blocking(&"any bytes".into())?;
    ///
    /// let ready = controller.wait_any_blocking(&mut [&mut sensor, &mut commands], Duration::from_secs(60))?;
    /// if ready.contains(&0) {
    ///     assert!(sensor.try_recv()?.is_some());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Those of `wait_any`; [`WaitError::Timeout`] if nothing arrived in time, [`WaitError::Blocking`] inside async
    /// code or after a stop request.
    pub fn wait_any_blocking(
        &self,
        gates: &mut [&mut dyn ReceivingGate],
        timeout: Duration,
    ) -> Result<Vec<usize>, WaitError> {
        let component = self.spec.name;
        let waited = self.handle.0.block_on_for(timeout, poll_fn(|cx| poll_any(gates, cx)));
        waited.map_err(|source| WaitError::Blocking { component, source })?.unwrap_or_else(|| {
            let gates = gates.iter().map(|gate| GateName::new(component, gate.spec().name)).collect();
            Err(WaitError::Timeout { component, gates, waited: timeout })
        })
    }
}

/// Polls all gates, so that each of them wakes the task.
fn poll_any(gates: &mut [&mut dyn ReceivingGate], cx: &mut Context<'_>) -> Poll<Result<Vec<usize>, WaitError>> {
    let mut ready = Vec::new();
    for (index, gate) in gates.iter_mut().enumerate() {
        if let Poll::Ready(polled) = gate.poll_ready(cx) {
            polled?;
            ready.push(index);
        }
    }
    if ready.is_empty() { Poll::Pending } else { Poll::Ready(Ok(ready)) }
}
