//! Which system is meant: the named one, that of the environment, the only one that runs, or that of the working
//! folder.

use crate::system::System;
use scl::runtime_dir::RuntimeDir;
use scl_loader::{Request, load};
use scl_terminal::{Problem, choose_system, closest_name, named_system, problem_of, quoted_list};
use std::ffi::OsString;
use std::path::Path;

const TOPOLOGY_FILE: &str = "topology.yaml";

impl System {
    /// Finds a system: the one with this name, else `$SCL_SYSTEM`, else the only one that runs, else that of
    /// `topology.yaml` in the working folder.
    ///
    /// # Errors
    /// The system does not exist, none or several run, or the runtime folder cannot be used. The text lists the running
    /// systems.
    pub fn find(name: Option<&str>) -> Result<Self, Problem> {
        Self::find_with(name, &environment, Path::new("."))
    }

    /// [`find`](Self::find) with another environment and working folder.
    ///
    /// # Errors
    /// Those of `find`.
    pub fn find_with(name: Option<&str>, variables: Variables<'_>, folder: &Path) -> Result<Self, Problem> {
        let Some(runtime_dir) = existing(variables)? else { return Err(no_runtime_folder()) };
        let is_named = named_system(name, variables)?.is_some();
        let running = running_systems(&runtime_dir)?;
        let Some(name) = choose_system(name, variables, &running, &|| system_of_folder(folder))? else {
            return Err(no_system(&runtime_dir));
        };
        match runtime_dir.existing_system(&name).map_err(|error| problem_of(&error))? {
            Some(dir) => Ok(Self::new(name, dir)),
            None if is_named => Err(unknown_system(&runtime_dir, &name)),
            None => Err(no_system(&runtime_dir)),
        }
    }

    /// [`find`](Self::find), but a named system need not have run here: its components are noticed when they start.
    ///
    /// # Errors
    /// The name is probably misspelled, because a system with a similar name exists; otherwise those of `find`.
    pub fn find_or_await(name: Option<&str>) -> Result<Self, Problem> {
        let problem = match Self::find(name) {
            Ok(found) => return Ok(found),
            Err(problem) => problem,
        };
        let Some(name) = named_system(name, &environment)? else { return Err(problem) };
        let known =
            existing(&environment)?.map(|runtime_dir| all_systems(&runtime_dir)).transpose()?.unwrap_or_default();
        if closest_name(&name, known.iter().map(String::as_str)).is_some() {
            return Err(problem);
        }
        let created = RuntimeDir::locate(&environment).and_then(|runtime_dir| runtime_dir.system(&name));
        created.map(|dir| Self::new(name, dir)).map_err(|error| problem_of(&error))
    }

    /// Finds the systems for a query that, without a name, shows all of them: the one with this name, else
    /// `$SCL_SYSTEM`, else all that run, else what [`find`](Self::find) finds.
    ///
    /// # Errors
    /// Those of `find`, except that several systems may run.
    pub fn find_all(name: Option<&str>) -> Result<Vec<Self>, Problem> {
        if let (None, Some(runtime_dir)) = (named_system(name, &environment)?, existing(&environment)?) {
            let running = running_systems(&runtime_dir)?.into_iter();
            let found =
                running.filter_map(|name| Some(Self::new(name.clone(), runtime_dir.existing_system(&name).ok()??)));
            let found: Vec<_> = found.collect();
            if !found.is_empty() {
                return Ok(found);
            }
        }
        Ok(vec![Self::find(name)?])
    }
}

/// A function that returns the value of an environment variable.
type Variables<'a> = &'a dyn Fn(&str) -> Option<OsString>;

fn environment(name: &str) -> Option<OsString> {
    std::env::var_os(name)
}

fn existing(variables: Variables<'_>) -> Result<Option<RuntimeDir>, Problem> {
    RuntimeDir::existing(variables).map_err(|error| problem_of(&error))
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
    // Errors elsewhere in the file do not matter here.
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
