//! Parameters, with the names that their types and values have in programs.

use scl_plan::{ParameterPlan, ParameterType};
use scl_topology::rust_name::{component_type, gate_field};
use scl_topology::source::Span;
use scl_topology::topology;

/// A parameter with all that its program needs.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// The name, as in the topology file.
    pub name: String,
    /// Its name in `snake_case`. It may be a keyword.
    pub snake_name: String,
    /// Where the name is written in the topology file.
    pub span: Span,
    /// Type, default, range, unit and documentation.
    pub plan: ParameterPlan,
    /// The enum of its values, if it is one of several words.
    pub choice: Option<Choice>,
}

/// The enum of a parameter that is one of several words.
#[derive(Debug, Clone)]
pub struct Choice {
    /// The name in `CamelCase`: `ControllerMode`.
    pub class_name: String,
    /// The values, in file order.
    pub values: Vec<ChoiceValue>,
}

/// A value of such an enum.
#[derive(Debug, Clone)]
pub struct ChoiceValue {
    /// The word, as in the topology file.
    pub word: String,
    /// The word in `CamelCase`: different for all values.
    pub class_name: String,
    /// The word in `snake_case`. It may be the same for two words.
    pub snake_name: String,
}

impl Parameter {
    /// A parameter of a component of no kind, or of a kind, with this name.
    pub(super) fn of(owner: &str, parameter: &topology::Parameter, plan: &ParameterPlan) -> Self {
        let choice = match &plan.kind {
            ParameterType::OneOf(words) => Some(Choice {
                class_name: topology::choice_name(owner, parameter.name()),
                values: words.iter().map(|word| ChoiceValue::of(word)).collect(),
            }),
            ParameterType::One(_) | ParameterType::List(..) => None,
        };
        Self {
            name: parameter.name().to_owned(),
            snake_name: gate_field(parameter.name()),
            span: parameter.span(),
            plan: plan.clone(),
            choice,
        }
    }
}

impl ChoiceValue {
    fn of(word: &str) -> Self {
        Self { word: word.to_owned(), class_name: component_type(word), snake_name: gate_field(word) }
    }
}
