//! Decides what to start: from a launch file, or from the cargo package beside the topology.

use super::cargo_package::{BuiltProgram, build_package};
use super::launch_file::{LaunchComponent, LaunchFile, parse_launch_file};
use super::problem::{Problem, print_err, quoted_list};
use super::program::{Program, check_programs};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

const LAUNCH_FILE: &str = "launch.yaml";
const TOPOLOGY_FILE: &str = "topology.yaml";

/// Reads the names of the components from a topology file, or says what is wrong with it and returns `None`.
pub type ComponentNames<'a> = &'a dyn Fn(&Path) -> Option<Vec<String>>;

/// Returns the programs to start for a system's folder or a launch file, after checking that each can be started.
///
/// # Errors
///
/// Every reason why the system cannot be started.
pub(crate) fn plan_programs(
    place: &Path,
    release: bool,
    component_names: ComponentNames<'_>,
) -> Result<Vec<Program>, Vec<Problem>> {
    let (folder, launch_path) = find_folder(place).map_err(|problem| vec![problem])?;
    let components = components_of(&folder, component_names)?;
    let programs = if launch_path.is_file() {
        plan_from_launch_file(&folder, &launch_path, components.as_deref())?
    } else {
        let components = components.ok_or_else(|| vec![nothing_to_start(&folder)])?;
        plan_from_package(&folder, &components, release)?
    };
    let problems = check_programs(&programs);
    if problems.is_empty() { Ok(programs) } else { Err(problems) }
}

/// The system's folder, and the path of its launch file, which need not exist.
fn find_folder(place: &Path) -> Result<(PathBuf, PathBuf), Problem> {
    let message = |words| format!("cannot run `{}`: {words}", place.display());
    let folder = if place.is_file() { place.parent().unwrap_or(Path::new("")) } else { place };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // Programs run elsewhere, so their paths must not depend on our working folder.
    let folder = folder.canonicalize().map_err(|error| {
        Problem::new(message(error.to_string())).help("give the folder of a system, or a launch file")
    })?;
    let launch_path = if place.is_file() { place.to_owned() } else { place.join(LAUNCH_FILE) };
    Ok((folder, launch_path))
}

/// The components of the topology beside the launch file, where there is one.
fn components_of(folder: &Path, names: ComponentNames<'_>) -> Result<Option<Vec<String>>, Vec<Problem>> {
    let path = folder.join(TOPOLOGY_FILE);
    if !path.is_file() {
        return Ok(None);
    }
    let invalid = || Problem::new("the topology has errors, so nothing was started").at(path.display().to_string());
    names(&path).map(Some).ok_or_else(|| vec![invalid()])
}

fn nothing_to_start(folder: &Path) -> Problem {
    Problem::new(format!("there is neither `{LAUNCH_FILE}` nor `{TOPOLOGY_FILE}` in `{}`", folder.display()))
        .help("give the folder of a system, or a launch file; `scl run --help` shows one")
}

fn plan_from_launch_file(
    folder: &Path,
    launch_path: &Path,
    components: Option<&[String]>,
) -> Result<Vec<Program>, Vec<Problem>> {
    let shown = launch_path.display().to_string();
    let text = std::fs::read_to_string(launch_path)
        .map_err(|error| vec![Problem::new(format!("cannot read the launch file: {error}")).at(&shown)])?;
    let launch = parse_launch_file(&shown, &text, components)?;
    note_missing(&launch, components.unwrap_or(&[]));
    Ok(launch.components.iter().map(|component| plan_component(folder, &launch, component)).collect())
}

/// A launch file may omit components that are started elsewhere (another terminal, a replay), but not silently.
fn note_missing(launch: &LaunchFile, components: &[String]) {
    let is_launched = |name: &String| launch.components.iter().any(|component| component.name == *name);
    let missing: Vec<&str> = components.iter().filter(|name| !is_launched(name)).map(String::as_str).collect();
    if !missing.is_empty() {
        print_err(&format!("note: not in the launch file, so not started: {}\n", quoted_list(missing)));
    }
}

fn plan_component(folder: &Path, launch: &LaunchFile, component: &LaunchComponent) -> Program {
    let transport = launch.transport.iter().map(|word| ("SCL_TRANSPORT".to_owned(), word.clone()));
    let environment = launch.environment.iter().chain(&component.environment).cloned();
    Program {
        component: component.name.clone(),
        command: component.command.iter().map(OsString::from).collect(),
        environment: transport.chain(environment).collect(),
        folder: component.folder.as_ref().map_or_else(|| folder.to_owned(), |own| folder.join(own)),
    }
}

fn plan_from_package(folder: &Path, components: &[String], release: bool) -> Result<Vec<Program>, Vec<Problem>> {
    let built = build_package(folder, release).map_err(|problem| vec![problem])?;
    let program_of = |name: &String| built.iter().find(|program| plays(program, name));
    let missing: Vec<&str> = components.iter().filter(|name| program_of(name).is_none()).map(String::as_str).collect();
    if !missing.is_empty() {
        return Err(vec![missing_programs(folder, &missing, &built)]);
    }
    let plan = |(component, program): (&String, &BuiltProgram)| Program {
        component: component.clone(),
        command: vec![program.executable.clone().into_os_string()],
        environment: Vec::new(),
        folder: folder.to_owned(),
    };
    Ok(components.iter().filter_map(|name| Some((name, program_of(name)?))).map(plan).collect())
}

/// Cargo targets are often named with hyphens, which component names cannot contain.
fn plays(program: &BuiltProgram, component: &str) -> bool {
    program.name == component || program.name.replace('-', "_") == component
}

fn missing_programs(folder: &Path, missing: &[&str], built: &[BuiltProgram]) -> Problem {
    let noun = if missing.len() == 1 { "component" } else { "components" };
    let problem = Problem::new(format!("no program for the {noun} {}", quoted_list(missing.iter().copied())));
    let programs = quoted_list(built.iter().map(|program| program.name.as_str()));
    let found = if built.is_empty() { "no programs".to_owned() } else { format!("the programs {programs}") };
    problem
        .help(format!("add `src/bin/{}.rs`, or say in `{LAUNCH_FILE}` how to start it", missing[0]))
        .note(format!("the cargo package in `{}` has {found}", folder.display()))
}
