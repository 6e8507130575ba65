//! Errors of setting a live parameter.

use super::suggestion;
use thiserror::Error;

/// A parameter was not set.
#[derive(Debug, Error, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub enum SetError {
    /// The component has no parameter of this name.
    #[error("component `{component}` has no parameter `{parameter}`{}", suggestion(nearest))]
    NoSuchParameter {
        /// The component.
        component: &'static str,
        /// The name of the parameter.
        parameter: String,
        /// The parameter that was probably meant.
        nearest: Option<String>,
    },
    /// The parameter keeps its value while the program runs.
    #[error(
        "parameter `{component}.{parameter}` is fixed while its program runs: its declaration does not say \
         `live: true`; give the value at the start, with `scl run --set {component}.{parameter}=...`"
    )]
    Fixed {
        /// The component.
        component: &'static str,
        /// The parameter.
        parameter: &'static str,
    },
    /// The parameter cannot have the value.
    #[error("parameter `{component}.{parameter}` cannot have this value: {reason}")]
    WrongValue {
        /// The component.
        component: &'static str,
        /// The parameter.
        parameter: &'static str,
        /// Why.
        reason: String,
    },
}
