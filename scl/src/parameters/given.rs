//! The values of a component's parameters at its start: those that are given, else the defaults.

use crate::environment::Variables;
use crate::error::OpenError;
use crate::options::OpenOptions;
use crate::set_variable;
use crate::spec::ComponentSpec;
use crate::values::{Value, index_of};
use scl_plan::{Assignment, ParameterPlan};

/// The values of the parameters, in file order. A value of the options counts more than one of the environment, which
/// has no effect in a unit test. None for a tool in the place of the program.
///
/// # Errors
/// A value is given to a parameter that the component does not have, a value cannot be that of its parameter, or a
/// parameter has no value.
pub(crate) fn values(
    spec: &'static ComponentSpec,
    options: &OpenOptions,
    variables: Variables<'_>,
) -> Result<Vec<Value>, OpenError> {
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
    for Assignment { parameter, .. } in &given {
        let unknown =
            |nearest| OpenError::NoSuchParameter { component: spec.name, parameter: parameter.clone(), nearest };
        index_of(spec, parameter).map_err(unknown)?;
    }
    spec.parameters.iter().map(|parameter| value(spec, parameter, &given)).collect()
}

fn value(
    spec: &'static ComponentSpec,
    parameter: &'static ParameterPlan,
    given: &[Assignment],
) -> Result<Value, OpenError> {
    let (component, name) = (spec.name, &*parameter.name);
    // The last one counts.
    let given = given.iter().rfind(|assignment| assignment.parameter == name).map(|assignment| &*assignment.value);
    let Some(text) = given.or(parameter.default.as_deref()) else {
        return Err(OpenError::NoValue { component, parameter: name, kind: parameter.kind.to_string() });
    };
    let value = parameter.read(text);
    let value = value.map_err(|reason| OpenError::WrongValue { component, parameter: name, reason })?;
    Ok(Value::new(text, value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use scl_plan::{ParameterType, ParameterValue, Scalar};
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
            live: false,
            declared_at: Cow::Borrowed("rover.yaml:2:5"),
        }],
        gates: &[],
        schema: None,
    };

    fn gain(options: &OpenOptions, variable: &str) -> Result<i128, String> {
        let variables = |name: &str| (name == "SCL_SET").then(|| OsString::from(variable));
        let found = values(SPEC, options, &variables).map_err(|error| error.to_string())?;
        match found.iter().map(Value::get).collect::<Vec<_>>().as_slice() {
            [ParameterValue::Integer(value)] => Ok(*value),
            others => panic!("{others:?}"),
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
