//! The names of components and gates as people write them, and in names of files.
//!
//! A component in a group has the group's name before its own: `left_arm.planner`. A gate has the name of its component
//! before its own: `left_arm.planner.command`. Its own name contains no dot.

/// Splits the full name of a gate into component and gate. `None` without a dot.
///
/// ```
/// use scl_text::gate_name::split;
///
/// assert_eq!(split("sensor.measurements"), Some(("sensor", "measurements")));
/// assert_eq!(split("left_arm.planner.command"), Some(("left_arm.planner", "command")));
/// assert_eq!(split("sensor"), None);
/// ```
pub fn split(name: &str) -> Option<(&str, &str)> {
    name.rsplit_once('.')
}

/// A name that may be that of a component or of a gate: the component, and the gate if it is one. `is_component` knows
/// the components; no component has the name of a group.
///
/// ```
/// use scl_text::gate_name::component_and_gate;
///
/// let is_component = |name: &str| name == "left_arm.planner";
/// assert_eq!(component_and_gate("left_arm.planner", is_component), ("left_arm.planner", None));
/// assert_eq!(component_and_gate("left_arm.planner.command", is_component), ("left_arm.planner", Some("command")));
/// ```
pub fn component_and_gate(name: &str, is_component: impl Fn(&str) -> bool) -> (&str, Option<&str>) {
    match split(name) {
        Some((component, gate)) if !is_component(name) => (component, Some(gate)),
        _ => (name, None),
    }
}

/// The groups that a component is in, from the innermost to the outermost: `left_arm.hand` and `left_arm` for
/// `left_arm.hand.finger`.
pub fn groups_of(component: &str) -> impl Iterator<Item = &str> {
    component.rmatch_indices('.').map(|(at, _)| &component[..at])
}

/// What stands for a component in names of files, where a dot separates it from what follows: `left_arm+planner`.
pub fn in_file_name(component: &str) -> String {
    component.replace('.', "+")
}

/// The component that [`in_file_name`] stands for.
pub fn from_file_name(text: &str) -> String {
    text.replace('+', ".")
}

/// What stands for a gate in names of files: `left_arm+planner.command`.
pub fn gate_in_file_name(component: &str, gate: &str) -> String {
    format!("{}.{gate}", in_file_name(component))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_tell_components_apart() {
        for component in ["sensor", "left_arm.planner", "left_arm.hand.finger"] {
            let file = in_file_name(component);
            assert!(!file.contains('.'), "{file}");
            assert_eq!(from_file_name(&file), component);
        }
    }
}
