//! Which component an untyped program is.

use crate::component;
use crate::environment;
use crate::error::OpenError;
use crate::plan::{Plan, SystemPlan};

/// Returns the plan of a component or, for a [kind], of the component that the program was started as: the one that
/// `SCL_COMPONENT` names, which `scl run` and the unit files of `scl deploy` set.
///
/// ```
/// use scl::plan::{KindPlan, SystemPlan};
/// use scl::untyped::started_as;
///
/// let mut system = SystemPlan::from_json(include_str!("../../doc/rover.json"))?;
/// assert_eq!(started_as(&system, "sensor")?.component, "sensor");
///
/// // As the plan has it if `sensor` is `kind: device` in the topology file.
/// system.kinds = vec![KindPlan { name: "device".to_owned(), components: vec!["sensor".to_owned()] }];
/// let error = started_as(&system, "device").unwrap_err();
/// assert_eq!(error.to_string(), "this program is a `device`: set SCL_COMPONENT to `sensor`");
/// # Ok::<(), scl::Error>(())
/// ```
///
/// # Errors
/// [`OpenError::UnknownComponent`] if the plan has neither a component nor a kind of this name;
/// [`OpenError::WhichComponent`] if a program of a kind was started as none of its components, or as several.
///
/// [kind]: crate::plan::KindPlan
pub fn started_as<'p>(system: &'p SystemPlan, name: &str) -> Result<&'p Plan, OpenError> {
    let Some(kind) = system.kind(name) else { return Ok(system.component(name)?) };
    let names: Vec<&str> = kind.components.iter().map(String::as_str).collect();
    let index = component::started_as(&system.system, name, &names, &environment::of_process)?;
    Ok(system.component(names[index])?)
}
