//! Which components the process was started for: `SCL_COMPONENT`, which `scl run` and its unit files set. A program
//! that is started in another's place, by swapped commands or as the program of the same name of another project, must
//! not run.

use crate::environment::{self, Variables};
use crate::error::OpenError;
use crate::service;
use crate::spec::ComponentSpec;

/// The environment variable. Its value is `rover.sensor`, or `sensor` for any system; several are separated by commas.
/// The name of a component may contain dots, that of a system cannot.
const VARIABLE: &str = "SCL_COMPONENT";

/// What the process was started as.
pub(super) struct Started(Option<String>);

impl Started {
    pub(super) fn read(variables: Variables<'_>) -> Result<Self, OpenError> {
        environment::read(variables, VARIABLE, "components like `rover.sensor`", |text| Some(text.to_owned())).map(Self)
    }

    /// Whether a component is among them.
    pub(super) fn includes(&self, system: &str, component: &str) -> bool {
        self.names().any(|name| name == component || name.split_once('.') == Some((system, component)))
    }

    /// For messages: `` `gps` of system `rover` ``; nothing if the variable is not set. The names of `components` are
    /// known not to begin with that of a system.
    pub(super) fn shown(&self, components: &[&str]) -> Option<String> {
        let one = |name: &str| match name.split_once('.') {
            Some((system, component)) if !components.contains(&name) => format!("`{component}` of system `{system}`"),
            _ => format!("`{name}`"),
        };
        self.0.as_ref().map(|_| self.names().map(one).collect::<Vec<_>>().join(" or "))
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.0.iter().flat_map(|text| text.split(',')).map(str::trim).filter(|name| !name.is_empty())
    }
}

/// Checks that the component is expected, if the variable is set. If it is not, this also notifies `scl run`.
///
/// # Errors
/// [`OpenError::Unexpected`].
pub(super) fn check(spec: &'static ComponentSpec, variables: Variables<'_>) -> Result<(), OpenError> {
    let started = Started::read(variables)?;
    let Some(expected) = started.shown(&[spec.name]).filter(|_| !started.includes(spec.system, spec.name)) else {
        return Ok(());
    };
    // A custom variable, with the prefix `X_` that `sd_notify(3)` recommends.
    service::tell(variables, &format!("X_SCL_OPENS={}.{}\n", spec.system, spec.name));
    Err(OpenError::Unexpected { component: spec.name, system: spec.system, expected })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ffi::OsString;

    fn result(expected: Option<&str>) -> Result<(), String> {
        const SPEC: &ComponentSpec = &ComponentSpec {
            system: "rover",
            name: "sensor",
            declared_at: "rover.yaml:1:1",
            parameters: &[],
            gates: &[],
            schema: None,
        };
        let variables = |name: &str| (name == VARIABLE).then_some(expected?).map(OsString::from);
        check(SPEC, &variables).map_err(|error| error.to_string())
    }

    #[test]
    fn a_component_in_a_group_is_expected_with_and_without_its_system() {
        let includes = |value: &str, component: &str| Started(Some(value.to_owned())).includes("rover", component);
        for value in ["rover.left_arm.planner", "left_arm.planner", "gps, left_arm.planner"] {
            assert!(includes(value, "left_arm.planner"), "{value}");
        }
        for value in ["planner", "right_arm.planner", "left_arm", "drone.left_arm.planner", "rover.planner"] {
            assert!(!includes(value, "left_arm.planner"), "{value}");
        }
        assert!(!includes("rover.left_arm.planner", "planner"));
    }

    #[test]
    fn only_an_expected_component_is_opened() {
        for expected in [None, Some(""), Some("rover.sensor"), Some("sensor"), Some("rover.gps, rover.sensor")] {
            assert_eq!(result(expected), Ok(()), "{expected:?}");
        }
        let refused = "component `sensor` of system `rover` was not expected: this program was started as ";
        let help = "; correct its command in the launch file, or allow it there with `opens: [sensor]`";
        let cases = [
            ("rover.gps", "`gps` of system `rover`"),
            ("drone.sensor", "`sensor` of system `drone`"),
            ("gps", "`gps`"),
            ("rover.a,rover.b", "`a` of system `rover` or `b` of system `rover`"),
        ];
        for (expected, shown) in cases {
            assert_eq!(result(Some(expected)), Err(format!("{refused}{shown}{help}")), "{expected}");
        }
    }
}
