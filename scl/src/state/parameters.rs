//! The parameters of a component: their values at its start, and setting those that are live.

use super::ComponentState;
use crate::error::SetError;
use crate::registration::ValuesWriter;
use crate::values::{Value, Values};

impl ComponentState {
    /// Gives its parameters their values, which are written to the file whenever they change.
    pub(crate) fn with_parameters(mut self, values: Vec<Value>, file: Option<ValuesWriter>) -> Self {
        self.parameters = Values::new(values, file);
        self
    }

    /// Keeps what listens for new values of live parameters until the component is closed.
    #[cfg_attr(not(feature = "zeromq"), expect(dead_code, reason = "only that transport has sockets"))]
    pub(crate) fn keep_setter(&self, setter: impl Send + Sync + 'static) {
        let kept = self.setter.set(Box::new(setter)).is_ok();
        debug_assert!(kept, "a component is opened once");
    }

    /// Sets live parameters, given by name as texts: all of them, or none. Tells everybody who waits for a change.
    pub(crate) fn set_parameters<'v>(
        &self,
        wanted: impl IntoIterator<Item = (&'v str, &'v str)>,
    ) -> Result<(), SetError> {
        if self.parameters.set(self.spec, wanted)? {
            self.changes.report();
        }
        Ok(())
    }
}
