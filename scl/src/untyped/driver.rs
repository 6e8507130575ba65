//! Waiting for futures from plain threads.

use crate::error::BlockingError;
use crate::state::ComponentState;
use std::sync::Weak;
use std::time::Duration;

/// Waits for futures of a component's gates from a plain thread, in steps: for bindings to languages that have to check
/// something else now and then, for example signals.
#[derive(Debug, Clone)]
pub struct Driver {
    /// Weak, so that it does not keep the component open.
    pub(super) state: Weak<ComponentState>,
}

impl Driver {
    /// Waits until a future is ready, but no longer than `time`. Returns `None` if it is still pending then; the next
    /// call continues with it.
    ///
    /// ```
    /// use scl::plan::SystemPlan;
    /// use scl::untyped::Component;
    /// use std::pin::pin;
    /// use std::time::Duration;
    /// # fn main() -> scl::Result<()> {
    /// # let options = scl::OpenOptions::new().transport(scl::transport::memory::Memory::new());
    ///
    /// let system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
    /// let mut recorder = Component::open_blocking_with(system.component("recorder")?, options)?;
    /// let (mut log, driver) = (recorder.puller("log")?, recorder.driver());
    ///
    /// let mut message = pin!(log.recv());
    /// assert!(driver.wait_for(message.as_mut(), Duration::from_millis(1))?.is_none());
    /// assert!(driver.wait_for(message.as_mut(), Duration::from_millis(1))?.is_none());
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// Inside async code, after a stop request, or if the component cannot be used any more.
    pub fn wait_for<F: Future>(&self, future: F, time: Duration) -> Result<Option<F::Output>, BlockingError> {
        let state = self.state.upgrade().ok_or(BlockingError::Closed)?;
        state.block_on_for(time, future)
    }
}
