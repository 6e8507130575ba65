//! The program that records a simulation: `scl record`, which takes part in it as the components do.

use super::component::Component;
use super::kept_values::KeptValues;
use super::orphan_guard::THIS_PROGRAM;
use super::plan::RunPlan;
use super::policy::Policy;
use super::program::Program;
use scl_terminal::Problem;
use std::ffi::OsString;
use std::path::{Path, PathBuf, absolute};

/// Returns the program that records the messages of a system, and in whose folder it finds the topology.
///
/// # Errors
///
/// If the system has no name.
pub(crate) fn plan_recorder(plan: &RunPlan, folder: PathBuf, recording: &Path) -> Result<Component, Problem> {
    let no_system = || {
        Problem::new("there is no topology file, so nothing can be recorded")
            .help("put `topology.yaml` beside the launch file, or leave out `--output`")
    };
    let system = plan.system.as_ref().ok_or_else(no_system)?;
    let unusable = |error| Problem::new(format!("cannot use `{}`: {error}", recording.display()));
    let file = absolute(recording).map_err(unusable)?;
    let words: [OsString; 6] =
        [THIS_PROGRAM.into(), "record".into(), "--system".into(), system.into(), "--output".into(), file.into()];
    Ok(Component {
        name: "recorder".to_owned(),
        kind: None,
        program: Program::new(words.into(), folder),
        policy: Policy::default(),
        recording: None,
        made_by_cargo: None,
        entry: None,
        kept: KeptValues::default(),
    })
}
