//! The parameters of an open component, as C programs read them.

mod items;

use crate::border::Wait;
use crate::error::Failure;
use crate::status::*;
pub(crate) use items::Items;
use scl::plan::ParameterPlan;
use scl::untyped::Component;
use scl_text::suggest::closest_name;
use std::pin::pin;
use std::sync::{PoisonError, RwLock};
use std::time::Duration;

/// The parameters of a component with the values that its program knows.
pub(crate) struct Parameters {
    pub(crate) component: &'static str,
    known: RwLock<Known>,
}

struct Known {
    /// How often live parameters had changed when the values were read.
    changes: u64,
    all: Vec<(&'static ParameterPlan, Items)>,
}

impl Parameters {
    /// The values of an open component.
    pub(crate) fn of(component: &Component) -> Self {
        // First, so that a change in between is taken over by the next update.
        let changes = component.parameter_changes();
        let spec = component.spec();
        let values = spec.parameters.iter();
        let value = |plan: &'static ParameterPlan| Some((plan, Items::of(plan, &component.parameter(&plan.name)?)));
        Self { component: spec.name, known: RwLock::new(Known { changes, all: values.filter_map(value).collect() }) }
    }

    /// Takes over live parameters that have changed, and waits until one has. Returns false if none has in time.
    pub(crate) fn update(&self, component: &Component, wait: Wait) -> Result<bool, Failure> {
        let changes = match wait {
            Wait::No => component.parameter_changes(),
            _ => self.changed(component, wait.limit())?,
        };
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        debug_assert!(changes >= known.changes, "changes are only added");
        if changes == known.changes {
            return Ok(false);
        }
        known.changes = changes;
        for (plan, items) in known.all.iter_mut().filter(|(plan, _)| plan.live) {
            if let Some(value) = component.parameter(&plan.name) {
                *items = Items::of(plan, &value);
            }
        }
        Ok(true)
    }

    /// Waits until live parameters have changed, and returns how often.
    fn changed(&self, component: &Component, limit: Duration) -> Result<u64, Failure> {
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner).changes;
        let changed = pin!(component.parameters_changed(known));
        let waited = component.driver().wait_for(changed, limit).map_err(|error| Failure::of_any(&error))?;
        waited.map_or(Ok(known), |changes| changes.map_err(|error| Failure::of_any(&error)))
    }

    /// Calls `read` with a parameter and its values.
    pub(crate) fn read<R>(
        &self,
        name: &str,
        read: impl FnOnce(&'static ParameterPlan, &Items) -> Result<R, Failure>,
    ) -> Result<R, Failure> {
        let known = self.known.read().unwrap_or_else(PoisonError::into_inner);
        let found = known.all.iter().find(|(parameter, _)| parameter.name == name);
        let (parameter, items) = found.ok_or_else(|| self.unknown(name, &known))?;
        read(parameter, items)
    }

    #[cold]
    fn unknown(&self, name: &str, known: &Known) -> Failure {
        let near = closest_name(name, known.all.iter().map(|(parameter, _)| &*parameter.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
        Failure::new(SCL_NAME, format!("component `{}` has no parameter `{name}`{near}", self.component))
    }

    #[cold]
    pub(crate) fn wrong_type(&self, parameter: &ParameterPlan, expected: &str) -> Failure {
        let ParameterPlan { name, kind, .. } = parameter;
        Failure::new(SCL_KIND, format!("parameter `{}.{name}` ({kind}) is not {expected}", self.component))
    }
}
