//! Which system is meant: the named one, that of the environment, the only one that runs, or that of the working folder.

use scl::runtime_dir::{RuntimeDir, RuntimeDirError, SystemDir};
use scl_loader::{Request, load};
use scl_terminal::{Problem, closest_name, quoted_list};
use std::error::Error;
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
    let existing = RuntimeDir::existing(variables).map_err(|error| from_runtime_dir(&error))?;
    let Some(runtime_dir) = existing else { return Err(no_runtime_folder()) };
    let name = match chosen_name(name, variables)? {
        Some(name) => name,
        None => only_name(&runtime_dir, folder)?,
    };
    match runtime_dir.existing_system(&name).map_err(|error| from_runtime_dir(&error))? {
        Some(dir) => Ok((name, dir)),
        None => Err(unknown_system(&runtime_dir, &name)),
    }
}

fn chosen_name(name: Option<&str>, variables: Variables<'_>) -> Result<Option<String>, Problem> {
    if let Some(name) = name {
        return Ok(Some(name.to_owned()));
    }
    let Some(value) = variables("SCL_SYSTEM").filter(|value| !value.is_empty()) else { return Ok(None) };
    let not_text = |value: OsString| {
        Problem::new(format!("`SCL_SYSTEM` is `{}`, which is not a name in UTF-8", value.to_string_lossy()))
            .help("name the system with `--system`")
    };
    value.into_string().map(Some).map_err(not_text)
}

/// The only running system, or the one of the topology file in `folder`.
fn only_name(runtime_dir: &RuntimeDir, folder: &Path) -> Result<String, Problem> {
    let running = running_systems(runtime_dir)?;
    if let [only] = &running[..] {
        return Ok(only.clone());
    }
    let own = system_of_folder(folder);
    match own {
        Some(name) if running.contains(&name) => Ok(name),
        _ if !running.is_empty() => Err(several_systems(&running)),
        Some(name) if matches!(runtime_dir.existing_system(&name), Ok(Some(_))) => Ok(name),
        _ => Err(no_system(runtime_dir)),
    }
}

fn running_systems(runtime_dir: &RuntimeDir) -> Result<Vec<String>, Problem> {
    let mut systems = all_systems(runtime_dir)?;
    systems.retain(|name| is_running(runtime_dir, name));
    Ok(systems)
}

fn all_systems(runtime_dir: &RuntimeDir) -> Result<Vec<String>, Problem> {
    let unreadable = |error| Problem::new(format!("cannot read `{}`: {error}", runtime_dir.path().display()));
    runtime_dir.systems().map_err(unreadable)
}

fn is_running(runtime_dir: &RuntimeDir, system: &str) -> bool {
    // Folders that are not safe, or disappear meanwhile, are no systems that could be observed.
    let Ok(Some(dir)) = runtime_dir.existing_system(system) else { return false };
    let components = dir.components().unwrap_or_default();
    components.iter().any(|component| crate::Component::read(&dir, component).is_running())
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

fn several_systems(running: &[String]) -> Problem {
    Problem::new("several systems are running")
        .help(format!("name one: `--system {}`, or set `SCL_SYSTEM`", running[0]))
        .note(format!("running: {}", quoted_list(running.iter().map(String::as_str))))
}

fn no_system(runtime_dir: &RuntimeDir) -> Problem {
    let problem =
        Problem::new("no system is running").help("start one, for example with `scl run`").note(looked_in(runtime_dir));
    let stopped = all_systems(runtime_dir).unwrap_or_default();
    match stopped.is_empty() {
        true => problem,
        false => problem.note(format!("stopped: {}", quoted_list(stopped.iter().map(String::as_str)))),
    }
}

fn unknown_system(runtime_dir: &RuntimeDir, name: &str) -> Problem {
    let all = all_systems(runtime_dir).unwrap_or_default();
    let problem = Problem::new(format!("there is no system `{}`", scl_terminal::escape(name)));
    let problem = match closest_name(name, all.iter().map(String::as_str)) {
        Some(close) => problem.help(format!("did you mean `{close}`?")),
        None => problem.help("start it, for example with `scl run`"),
    };
    let problem = problem.note(looked_in(runtime_dir));
    let running: Vec<String> = all.into_iter().filter(|name| is_running(runtime_dir, name)).collect();
    match running.is_empty() {
        true => problem.note("no system is running there"),
        false => problem.note(format!("running: {}", quoted_list(running.iter().map(String::as_str)))),
    }
}

fn looked_in(runtime_dir: &RuntimeDir) -> String {
    format!("looked in `{}` (`SCL_RUNTIME_DIR` chooses another folder)", runtime_dir.path().display())
}

/// The texts of the runtime have their way out in the second line.
fn from_runtime_dir(error: &RuntimeDirError) -> Problem {
    let (message, help) = message_and_help(error);
    let problem = Problem::new(message);
    match help {
        Some(help) => problem.help(help),
        None => problem,
    }
}

/// What is wrong with the runtime folder, and what to do.
pub(crate) fn message_and_help(error: &RuntimeDirError) -> (String, Option<String>) {
    let text = error.to_string();
    let (message, help) = text.split_once("\nhelp: ").map_or((&*text, None), |(message, help)| (message, Some(help)));
    let message = match error.source() {
        Some(source) => format!("{message}: {source}"),
        None => message.to_owned(),
    };
    (message, help.map(str::to_owned))
}
