//! Components of unit tests: opened together with the other ends of their gates.

use super::Component;
use crate::error::OpenError;
use crate::options::OpenOptions;
use crate::plan::Plan;
use crate::transport::memory::Memory;
use std::time::Duration;

impl Component {
    /// Opens a component for a unit test, together with its counterpart, which has the opposite end of each gate under
    /// the same name, without processes, sockets or files.
    ///
    /// Queues, policies and timeouts of the component are those of its plan; of a gate with several connections, the
    /// first counts. The counterpart drops and refuses nothing, and is called `controller's peers` in errors. All gates
    /// are connected.
    ///
    /// ```
    /// use scl::plan::SystemPlan;
    /// use scl::untyped::Component;
    /// # #[tokio::main(flavor = "current_thread")]
    /// # async fn main() -> scl::Result<()> {
    ///
    /// let system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
    /// let (mut sensor, mut peer) = Component::test(system.component("sensor")?).await?;
    ///
    /// let (mut sends, mut receives) = (sensor.pusher("log")?, peer.puller("log")?);
    /// sends.send(&"any bytes".into()).await?;
    /// assert_eq!(receives.recv().await?, "any bytes");
    /// # Ok(())
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`OpenError`]: the plan contradicts itself, or there is no tokio runtime.
    ///
    /// # Cancel safety
    /// Nothing stays open.
    pub async fn test(plan: &Plan) -> Result<(Self, Self), OpenError> {
        let options = OpenOptions::new().for_test(Memory::of_test());
        let component = Self::open_with(plan, options.clone()).await?;
        let peer = Self::open_with(&plan.counterpart(), options).await?;
        for end in [&component, &peer] {
            connected(end, end.ready(CONNECTING).await.map_err(Into::into));
        }
        Ok((component, peer))
    }

    /// [`test`](Self::test) for the blocking and the non-waiting calls of gates.
    ///
    /// # Errors
    /// [`OpenError`]: the plan contradicts itself, or the operating system refuses a runtime.
    pub fn test_blocking(plan: &Plan) -> Result<(Self, Self), OpenError> {
        Self::test_blocking_with(plan, OpenOptions::new())
    }

    /// [`test_blocking`](Self::test_blocking) with values of parameters, as [`OpenOptions::set`] sets them. Other
    /// options have no effect.
    ///
    /// # Errors
    /// [`OpenError`]: also if a value cannot be that of its parameter.
    pub fn test_blocking_with(plan: &Plan, options: OpenOptions) -> Result<(Self, Self), OpenError> {
        let options = options.for_test(Memory::of_test());
        let component = Self::open_blocking_with(plan, options.clone())?;
        let peer = Self::open_blocking_with(&plan.counterpart(), options)?;
        for end in [&component, &peer] {
            connected(end, end.ready_blocking(CONNECTING));
        }
        Ok((component, peer))
    }
}

/// Time limit for connecting, far longer than it takes.
const CONNECTING: Duration = Duration::from_secs(10);

/// Logs a warning if the component is not connected yet. This is not an error: calls of the test that wait for a peer
/// will report it.
fn connected(component: &Component, ready: crate::Result<()>) {
    if let Err(error) = ready {
        tracing::warn!("{component:?} is not connected yet: {error}");
    }
}
