//! Checked parameters, and the types that programs have for them.

use crate::rust_name::component_type;
use crate::source::Span;
use scl_plan::ParameterPlan;

/// The type of the parameters of a component or kind in programs: `ControllerParameters`.
pub fn parameters_name(owner: &str) -> String {
    format!("{}Parameters", component_type(owner))
}

/// The type of a parameter that is one of several words: `ControllerMode`.
pub fn choice_name(owner: &str, parameter: &str) -> String {
    component_type(&format!("{owner}_{parameter}"))
}

/// A checked parameter.
#[derive(Debug, Clone)]
pub struct Parameter {
    pub(crate) declared: ParameterPlan,
    pub(crate) span: Span,
}

impl Parameter {
    /// The name in the file.
    pub fn name(&self) -> &str {
        &self.declared.name
    }
    /// All that the file says about it, without its place.
    pub fn declared(&self) -> &ParameterPlan {
        &self.declared
    }
    /// Where its name is written.
    pub fn span(&self) -> Span {
        self.span
    }
}
