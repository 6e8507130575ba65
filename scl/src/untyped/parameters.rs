//! Live parameters that change.

use super::Component;
use crate::error::BlockingError;
use std::pin::pin;
use std::sync::Arc;

impl Component {
    /// Returns how often live parameters have changed since the component was opened. A program that compares it with
    /// an earlier one knows whether to read its parameters again.
    pub fn parameter_changes(&self) -> u64 {
        self.handle.0.parameters.changes()
    }

    /// Waits until live parameters have changed more often than `known`, an earlier result of
    /// [`parameter_changes`](Self::parameter_changes), and returns how often. It does not keep the component open.
    ///
    /// ```
    /// # use scl::plan::SystemPlan;
    /// # use scl::untyped::Component;
    /// # async fn example(controller: &Component) -> scl::Result<()> {
    /// let mut known = controller.parameter_changes();
    /// loop {
    ///     println!("{:?}", controller.parameter("gain"));
    ///     known = controller.parameters_changed(known).await?;
    /// }
    /// # }
    /// ```
    ///
    /// # Errors
    /// [`BlockingError::Closed`] if the component was closed or its calls were ended, [`BlockingError::RuntimeEnded`]
    /// if its runtime has ended, [`BlockingError::Forked`] in a forked child.
    ///
    /// # Cancel safety
    /// Cancel safe: what has changed is still more than `known`.
    pub fn parameters_changed(&self, known: u64) -> impl Future<Output = Result<u64, BlockingError>> + Send + use<> {
        let (changes, state) = (self.handle.0.changes(), Arc::downgrade(&self.handle.0));
        async move {
            loop {
                let mut next = pin!(changes.next());
                // Registered before the look, so that no change is overlooked.
                next.as_mut().enable();
                {
                    let state = state.upgrade().ok_or(BlockingError::Closed)?;
                    state.check_silently()?;
                    let now = state.parameters.changes();
                    debug_assert!(now >= known, "changes are only added");
                    if now > known {
                        return Ok(now);
                    }
                }
                next.await;
            }
        }
    }
}
