//! Components of unit tests: opened together with the other ends of their gates.

use super::Component;
use crate::error::OpenError;
use crate::options::OpenOptions;
use crate::plan::Plan;
use crate::transport::memory::Memory;

impl Component {
    /// Opens a component for a unit test, together with its counterpart, which has the opposite end of each gate under the
    /// same name, without processes, sockets or files.
    ///
    /// Queues, policies and timeouts of the component are those of its plan. The counterpart drops and refuses nothing.
    /// Its component is called `controller's peers`, in errors for example.
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
    /// It never waits.
    pub async fn test(plan: &Plan) -> Result<(Self, Self), OpenError> {
        let options = OpenOptions::new().transport(Memory::new());
        let component = Self::open_with(plan, options.clone()).await?;
        Ok((component, Self::open_with(&plan.counterpart(), options).await?))
    }

    /// [`test`](Self::test) for the blocking and the non-waiting calls of gates.
    ///
    /// # Errors
    /// [`OpenError`]: the plan contradicts itself, or the operating system refuses a runtime.
    pub fn test_blocking(plan: &Plan) -> Result<(Self, Self), OpenError> {
        let options = OpenOptions::new().transport(Memory::new());
        let component = Self::open_blocking_with(plan, options.clone())?;
        Ok((component, Self::open_blocking_with(&plan.counterpart(), options)?))
    }
}
