//! The plans of all components of a system, which together are one JSON document.

use crate::error::UnknownComponent;
use crate::plan::Plan;
use scl_text::suggest::closest_name;

/// The plans of the components of one system, or of some of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SystemPlan {
    /// The system's name.
    pub system: String,
    /// One plan per component, in the order of the topology file.
    pub components: Vec<Plan>,
}

impl SystemPlan {
    /// The plan of one component.
    ///
    /// # Errors
    /// [`UnknownComponent`] if the system has none with this name; it suggests the nearest one.
    pub fn component(&self, name: &str) -> Result<&Plan, UnknownComponent> {
        self.components.iter().find(|plan| plan.component == name).ok_or_else(|| UnknownComponent {
            system: self.system.clone(),
            component: name.to_owned(),
            nearest: closest_name(name, self.components.iter().map(|plan| plan.component.as_str())).map(str::to_owned),
        })
    }
}
