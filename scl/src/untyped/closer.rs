//! Ending the calls of a component from another thread.

use crate::state::ComponentState;
use std::sync::Weak;

/// Ends the calls of a component and of its gates, wherever those are.
///
/// A program that closes a component while its threads wait in gates ends those calls first:
///
/// ```
/// use scl::plan::SystemPlan;
/// use scl::untyped::Component;
/// use std::time::Duration;
/// # fn main() -> scl::Result<()> {
/// # let options = scl::OpenOptions::new().transport(scl::transport::memory::Memory::new());
///
/// let system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
/// let mut recorder = Component::open_blocking_with(system.component("recorder")?, options)?;
/// let mut log = recorder.puller("log")?;
/// let closer = recorder.closer();
///
/// let waiting = std::thread::spawn(move || log.recv_blocking());
/// closer.end_calls();
/// let ended = scl::Error::from(waiting.join().unwrap().unwrap_err());
/// assert_eq!(format!("{ended:?}"), "gate `recorder.log` did not receive\n  caused by: the component was closed");
/// recorder.close_blocking(Duration::from_secs(1))?;
/// # Ok(())
/// # }
/// ```
#[derive(Debug, Clone)]
pub struct Closer {
    /// Weak, so that it does not keep the component open.
    pub(super) state: Weak<ComponentState>,
}

impl Closer {
    /// Ends all calls that wait, with [`BlockingError::Closed`](crate::BlockingError::Closed), and refuses later ones.
    /// It does not wait until they have returned. What was sent before can still be flushed, by closing the component.
    ///
    /// In async code, futures of the gates end as well, except that of `peers_changed`.
    pub fn end_calls(&self) {
        if let Some(state) = self.state.upgrade().filter(|state| !state.is_inherited()) {
            state.end_calls();
        }
    }
}
