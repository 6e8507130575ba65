//! Components in a simulation: only the processes that `scl simulate` has started take part. Those that they start run
//! in real time, and a component there would act at times that differ from run to run.

use crate::environment::Variables;
use crate::error::OpenError;
use crate::spec::ComponentSpec;

/// What `scl simulate` tells the library that a program loads: the format, the process, and descriptors.
const SEAT: &str = "SCL_SIMULATION";

/// Checks that this process does not descend from one that takes part in a simulation.
///
/// # Errors
/// [`OpenError::OutsideSimulation`].
pub(super) fn check(spec: &'static ComponentSpec, variables: Variables<'_>) -> Result<(), OpenError> {
    let Some(seat) = variables(SEAT) else { return Ok(()) };
    let process = seat.to_str().and_then(|seat| seat.split(',').nth(1));
    if process.is_some_and(|process| process == std::process::id().to_string()) {
        return Ok(());
    }
    Err(OpenError::OutsideSimulation { component: spec.name })
}
