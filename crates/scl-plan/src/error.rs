//! Why a text is not a plan, or a plan cannot work.

#[cfg(feature = "json")]
use crate::version::VERSION;
use scl_text::list::either;
use thiserror::Error;

/// A plan could not be read, or contradicts itself.
///
/// `at` is the path of a value in the JSON text: `components[0].gates[2].queue`, or `the document` for all of it.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum PlanError {
    /// The text is not JSON.
    #[cfg(feature = "json")]
    #[error("the plan is not valid JSON")]
    Syntax(#[source] serde_json::Error),
    /// The plan was written in another version of the format.
    #[cfg(feature = "json")]
    #[error(
        "this plan has version {found} of the format, but this program reads version {VERSION}; \
         write it again with `scl plan` from this release"
    )]
    Version {
        /// The version of the plan.
        found: u64,
    },
    /// A field that every plan has is missing.
    #[error("field `{field}` is missing in {at}")]
    Missing {
        /// The object that lacks it.
        at: String,
        /// The field.
        field: &'static str,
    },
    /// A field that no plan has.
    #[error("unknown field `{field}` in {at}{}", suggestion(nearest))]
    UnknownField {
        /// The object that contains it.
        at: String,
        /// The field.
        field: String,
        /// The field that may have been meant.
        nearest: Option<&'static str>,
    },
    /// A value has the wrong type or is out of its range.
    #[error("`{at}` must be {expected}, but it is {found}")]
    Value {
        /// The path of the value.
        at: String,
        /// What it must be.
        expected: String,
        /// The value, cut if it is long.
        found: String,
    },
    /// The values do not fit together.
    #[error("{part} {reason}")]
    Inconsistent {
        /// The gate or component: ``gate `controller.sensor` ``.
        part: String,
        /// The rest of the sentence: `is declared twice`.
        reason: String,
    },
    /// One component was expected.
    #[error("this plan has {count} components where one is expected; select one with `SystemPlan::component`")]
    NotOneComponent {
        /// How many it has.
        count: usize,
    },
}

/// A system has no component with a given name.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
#[error("system `{system}` has no component `{component}`{}", instead(nearest, of_kind))]
pub struct UnknownComponent {
    /// The system.
    pub system: String,
    /// The name that was looked for.
    pub component: String,
    /// The component that may have been meant.
    pub nearest: Option<String>,
    /// The components of the kind of this name, if there is one.
    pub of_kind: Vec<String>,
}

fn instead(nearest: &Option<String>, of_kind: &[String]) -> String {
    match of_kind {
        [] => suggestion(nearest),
        names => format!(", but a kind of this name: name one of its components, {}", either(names)),
    }
}

fn suggestion(nearest: &Option<impl std::fmt::Display>) -> String {
    nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default()
}
