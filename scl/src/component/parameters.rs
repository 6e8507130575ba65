//! The values of a component's parameters: those that are given, else the defaults.

use crate::environment::Variables;
use crate::error::OpenError;
use crate::options::OpenOptions;
use crate::set_variable;
use crate::spec::ComponentSpec;
use scl_plan::{Assignment, ParameterPlan, ParameterValue};
use scl_text::suggest::closest_name;
use std::time::Duration;

/// The values of the parameters, in file order. A value of the options counts more than one of the environment, which
/// has no effect in a unit test. None for a tool in the place of the program.
///
/// # Errors
/// A value is given to a parameter that the component does not have, a value cannot be that of its parameter, or a
/// parameter has no value.
pub(super) fn values(
    spec: &'static ComponentSpec,
    options: &OpenOptions,
    variables: Variables<'_>,
) -> Result<Vec<ParameterValue>, OpenError> {
    if options.stands_in {
        return Ok(Vec::new());
    }
    let mut given = if options.is_test { Vec::new() } else { set_variable::read(variables)? };
    given.retain(|assignment| assignment.component == spec.name);
    for (path, value) in &options.set {
        let assignment = Assignment::parse(&format!("{path}={value}"));
        let assignment = assignment.map_err(|reason| OpenError::Set { component: spec.name, reason })?;
        given.extend(Some(assignment).filter(|assignment| assignment.component == spec.name));
    }
    let is_known = |name: &str| spec.parameters.iter().any(|parameter| parameter.name == name);
    if let Some(unknown) = given.iter().find(|assignment| !is_known(&assignment.parameter)) {
        let nearest = closest_name(&unknown.parameter, spec.parameters.iter().map(|it| &*it.name)).map(str::to_owned);
        let parameter = unknown.parameter.clone();
        return Err(OpenError::NoSuchParameter { component: spec.name, parameter, nearest });
    }
    spec.parameters.iter().map(|parameter| value(spec, parameter, &given)).collect()
}

fn value(
    spec: &'static ComponentSpec,
    parameter: &'static ParameterPlan,
    given: &[Assignment],
) -> Result<ParameterValue, OpenError> {
    let (component, name) = (spec.name, &*parameter.name);
    // The last one counts.
    let given = given.iter().rfind(|assignment| assignment.parameter == name).map(|assignment| &*assignment.value);
    let Some(text) = given.or(parameter.default.as_deref()) else {
        return Err(OpenError::NoValue { component, parameter: name, kind: parameter.kind.to_string() });
    };
    parameter.read(text).map_err(|reason| OpenError::WrongValue { component, parameter: name, reason })
}

/// The Rust type of a parameter.
pub trait FromParameter: Sized {
    /// The value as this type; `None` if it is of another type.
    fn from_value(value: &ParameterValue) -> Option<Self>;
}

impl FromParameter for bool {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Bool(value) = value { Some(*value) } else { None }
    }
}

macro_rules! integers {
    ($($integer:ty)+) => {$(
        impl FromParameter for $integer {
            fn from_value(value: &ParameterValue) -> Option<Self> {
                if let ParameterValue::Integer(value) = value { (*value).try_into().ok() } else { None }
            }
        }
    )+};
}

integers!(i8 i16 i32 i64 u8 u16 u32 u64);

impl FromParameter for f64 {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Float(value) = value { Some(*value) } else { None }
    }
}

impl FromParameter for f32 {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        f64::from_value(value).map(|value| value as f32)
    }
}

impl FromParameter for String {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Text(value) = value { Some(value.clone()) } else { None }
    }
}

impl FromParameter for Duration {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::Duration(value) = value { Some(*value) } else { None }
    }
}

impl<T: FromParameter> FromParameter for Vec<T> {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        if let ParameterValue::List(values) = value { values.iter().map(T::from_value).collect() } else { None }
    }
}

impl<T: FromParameter, const LENGTH: usize> FromParameter for [T; LENGTH] {
    fn from_value(value: &ParameterValue) -> Option<Self> {
        Vec::from_value(value)?.try_into().ok()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl_plan::{ParameterType, Scalar};
    use std::borrow::Cow;
    use std::ffi::OsString;

    const SPEC: &ComponentSpec = &ComponentSpec {
        system: "rover",
        name: "arm.planner",
        declared_at: "rover.yaml:1:1",
        parameters: &[ParameterPlan {
            name: Cow::Borrowed("gain"),
            kind: ParameterType::One(Scalar::U8),
            default: Some(Cow::Borrowed("1")),
            range: None,
            unit: None,
            doc: None,
            declared_at: Cow::Borrowed("rover.yaml:2:5"),
        }],
        gates: &[],
        schema: None,
    };

    fn gain(options: &OpenOptions, variable: &str) -> Result<i128, String> {
        let variables = |name: &str| (name == "SCL_SET").then(|| OsString::from(variable));
        match values(SPEC, options, &variables).as_deref() {
            Ok([ParameterValue::Integer(value)]) => Ok(*value),
            Ok(others) => panic!("{others:?}"),
            Err(error) => Err(error.to_string()),
        }
    }

    #[test]
    fn options_count_more_than_the_environment_and_that_more_than_defaults() {
        let plain = OpenOptions::new;
        assert_eq!(gain(&plain(), ""), Ok(1));
        assert_eq!(gain(&plain(), "arm.planner.gain=2"), Ok(2));
        assert_eq!(gain(&plain(), "arm.planner.gain=2,planner.gain=300,arm.gain=x,arm.planner.gain=3"), Ok(3));
        assert_eq!(gain(&plain().set("arm.planner.gain", "4").set("other.gain", "x"), "arm.planner.gain=2"), Ok(4));
        let mut of_test = plain();
        of_test.is_test = true;
        assert_eq!(gain(&of_test, "arm.planner.gain=2"), Ok(1), "a test does not depend on its environment");
    }

    #[test]
    fn a_wrong_value_in_the_environment_is_refused() {
        let wrong = "parameter `arm.planner.gain` cannot have the value that it is set to: ";
        let wrong = format!("{wrong}expected a whole number from 0 to 255, found `300`");
        assert_eq!(gain(&OpenOptions::new(), "arm.planner.gain=300"), Err(wrong));
    }
}
