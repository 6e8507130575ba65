//! Checks that the components to be started are not running yet: a component runs only once. The check comes before the
//! builds, which may take long.

use super::control::{Command, NoAnswer, Request, find_runs};
use super::plan::RunPlan;
use scl::runtime_dir::{ComponentState, RuntimeDir};
use scl_terminal::{Problem, quoted_list};

/// Checks that no component of the plan is already running.
///
/// # Errors
///
/// If one is running, or if a `scl run` of this system does not answer or has a system of the same name from another
/// topology file. The problem names the process.
pub(crate) fn check(plan: &RunPlan) -> Result<(), Problem> {
    let Some(system) = &plan.system else { return Ok(()) };
    // An unusable runtime folder is reported later, where it is needed.
    let Ok(Some(dir)) = RuntimeDir::existing(&|name| std::env::var_os(name)) else { return Ok(()) };
    let names: Vec<&str> = plan.programs().map(|component| component.name.as_str()).collect();
    for run in find_runs(dir.path(), Some(system)).iter().filter(|run| run.process != std::process::id()) {
        let response = match run.ask(&Request::new(Command::List, Vec::new())) {
            Ok(response) => response,
            Err(NoAnswer::Ended) => continue,
            Err(error) => return Err(run.problem(&error)),
        };
        if let Some(problem) = run.other_system(response.named_after.as_deref(), plan.named_after.as_deref()) {
            return Err(problem.help("or set `SCL_SYSTEM` to another name for this one"));
        }
        let components = response.components;
        let running = components.iter().filter(|it| it.pid.is_some() && names.contains(&it.component.as_str()));
        let running: Vec<&str> = running.map(|it| it.component.as_str()).collect();
        if !running.is_empty() {
            let what = if running.len() == names.len() { format!("system `{system}`") } else { shown(&running) };
            let problem = Problem::new(format!("{what} is already running: `scl run` is process {}", run.process));
            return Err(
                problem.help("stop it with `scl stop`, or choose other components with `--only` or `--without`")
            );
        }
    }
    let Ok(Some(folder)) = dir.existing_system(system) else { return Ok(()) };
    for name in names {
        if let ComponentState::Running(holder) = folder.state(name) {
            let problem =
                Problem::new(format!("component `{name}` of system `{system}` is already running as {holder}"));
            return Err(problem.help(format!("stop it first, or start the others with `--without {name}`")));
        }
    }
    Ok(())
}

fn shown(components: &[&str]) -> String {
    let noun = if components.len() == 1 { "component" } else { "each of the components" };
    format!("{noun} {}", quoted_list(components))
}
