//! The parameters of an open component, as C programs read them.

mod items;

use crate::error::Failure;
use crate::status::*;
pub(crate) use items::Items;
use scl::plan::ParameterPlan;
use scl::untyped::Component;
use scl_text::suggest::closest_name;
use std::sync::{PoisonError, RwLock};

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

    /// Takes over live parameters that have changed. Returns false if none has.
    pub(crate) fn update(&self, component: &Component) -> bool {
        let changes = component.parameter_changes();
        let mut known = self.known.write().unwrap_or_else(PoisonError::into_inner);
        debug_assert!(changes >= known.changes, "changes are only added");
        if changes == known.changes {
            return false;
        }
        known.changes = changes;
        for (plan, items) in known.all.iter_mut().filter(|(plan, _)| plan.live) {
            if let Some(value) = component.parameter(&plan.name) {
                *items = Items::of(plan, &value);
            }
        }
        true
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
