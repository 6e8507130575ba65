//! Which system is meant: the named one, that of the environment, the only one that runs, or that of the working
//! folder.

use crate::scl_error::problem_of;
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl_loader::{Request, load};
use scl_terminal::{Problem, choose_system, closest_name, named_system, quoted_list};
use std::ffi::OsString;
use std::path::Path;

/// The value of an environment variable.
pub(crate) type Variables<'a> = &'a dyn Fn(&str) -> Option<OsString>;

const TOPOLOGY_FILE: &str = "topology.yaml";

/// Finds the folder of a system. `folder` is the working folder.
pub(crate) fn find_system(
    name: Option<&str>,
    variables: Variables<'_>,
    folder: &Path,
) -> Result<(String, SystemDir), Problem> {
    let existing = RuntimeDir::existing(variables).map_err(|error| problem_of(&error))?;
    let Some(runtime_dir) = existing else { return Err(no_runtime_folder()) };
    let is_named = named_system(name, variables)?.is_some();
    let running = running_systems(&runtime_dir)?;
    let Some(name) = choose_system(name, variables, &running, &|| system_of_folder(folder))? else {
        return Err(no_system(&runtime_dir));
    };
    match runtime_dir.existing_system(&name).map_err(|error| problem_of(&error))? {
        Some(dir) => Ok((name, dir)),
        None if is_named => Err(unknown_system(&runtime_dir, &name)),
        None => Err(no_system(&runtime_dir)),
    }
}

/// The system of [`find_system`], or the folder of a named one that has never run here.
pub(crate) fn find_or_create_system(
    name: Option<&str>,
    variables: Variables<'_>,
    folder: &Path,
) -> Result<(String, SystemDir), Problem> {
    let problem = match find_system(name, variables, folder) {
        Ok(found) => return Ok(found),
        Err(problem) => problem,
    };
    let Some(name) = named_system(name, variables)? else { return Err(problem) };
    let existing = RuntimeDir::existing(variables).map_err(|error| problem_of(&error))?;
    let known = existing.map(|runtime_dir| all_systems(&runtime_dir)).transpose()?.unwrap_or_default();
    if closest_name(&name, known.iter().map(String::as_str)).is_some() {
        return Err(problem);
    }
    let created = RuntimeDir::locate(variables).and_then(|runtime_dir| runtime_dir.system(&name));
    created.map(|dir| (name, dir)).map_err(|error| problem_of(&error))
}

/// The named system, or all that run, or that of [`find_system`].
pub(crate) fn find_systems(
    name: Option<&str>,
    variables: Variables<'_>,
    folder: &Path,
) -> Result<Vec<(String, SystemDir)>, Problem> {
    let existing = RuntimeDir::existing(variables).map_err(|error| problem_of(&error))?;
    if let (None, Some(runtime_dir)) = (named_system(name, variables)?, existing) {
        let running = running_systems(&runtime_dir)?.into_iter();
        let found = running.filter_map(|name| runtime_dir.existing_system(&name).ok().flatten().map(|dir| (name, dir)));
        let found: Vec<_> = found.collect();
        if !found.is_empty() {
            return Ok(found);
        }
    }
    Ok(vec![find_system(name, variables, folder)?])
}

fn running_systems(runtime_dir: &RuntimeDir) -> Result<Vec<String>, Problem> {
    runtime_dir.running_systems().map_err(|error| unreadable(runtime_dir, &error))
}

fn all_systems(runtime_dir: &RuntimeDir) -> Result<Vec<String>, Problem> {
    runtime_dir.systems().map_err(|error| unreadable(runtime_dir, &error))
}

fn unreadable(runtime_dir: &RuntimeDir, error: &std::io::Error) -> Problem {
    Problem::new(format!("cannot read `{}`: {error}", runtime_dir.path().display()))
}

/// The name of the system that the topology file in this folder describes.
fn system_of_folder(folder: &Path) -> Option<String> {
    let file = folder.join(TOPOLOGY_FILE);
    // Mistakes elsewhere in the file do not matter here.
    let loaded = file.is_file().then(|| load(&Request::new(file)))?;
    let checked = loaded.topology.as_ref().map(|topology| topology.system().to_owned());
    checked.or_else(|| Some(loaded.model.system?.value))
}

fn no_runtime_folder() -> Problem {
    Problem::new("no system is running")
        .help("start one, for example with `scl run`")
        .note("the runtime folder does not exist (`SCL_RUNTIME_DIR` chooses another)")
}

fn no_system(runtime_dir: &RuntimeDir) -> Problem {
    let problem =
        Problem::new("no system is running").help("start one, for example with `scl run`").note(looked_in(runtime_dir));
    let stopped = all_systems(runtime_dir).unwrap_or_default();
    match stopped.is_empty() {
        true => problem,
        false => problem.note(format!("stopped: {}", quoted_list(&stopped))),
    }
}

fn unknown_system(runtime_dir: &RuntimeDir, name: &str) -> Problem {
    let all = all_systems(runtime_dir).unwrap_or_default();
    let problem = Problem::new(format!("there is no system `{}`", scl_terminal::escape(name)));
    let problem = problem.did_you_mean_or(name, all.iter().map(String::as_str), |problem| {
        problem.help("start it, for example with `scl run`")
    });
    let problem = problem.note(looked_in(runtime_dir));
    let running = running_systems(runtime_dir).unwrap_or_default();
    match running.is_empty() {
        true => problem.note("no system is running there"),
        false => problem.note(format!("running: {}", quoted_list(&running))),
    }
}

fn looked_in(runtime_dir: &RuntimeDir) -> String {
    format!("looked in `{}` (`SCL_RUNTIME_DIR` chooses another folder)", runtime_dir.path().display())
}
