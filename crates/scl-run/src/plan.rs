//! Decides what to build and to start: from a launch file, or from the cargo package beside the topology.

mod cargo_builds;
mod host;
mod package;
mod parameters;

pub use host::{DeployedSystem, read_deployment};

use super::cargo::{Artifact, CargoRun};
use super::component::Component;
use super::deployment::Deployment;
use super::kept_values::KeptValues;
use super::launch_file::{LaunchComponent, LaunchDocument, LaunchFile, Settings, Source};
use super::orphan_guard::THIS_PROGRAM;
use super::placement::Placement;
use super::program::{Build, Program};
use super::selection::Selection;
use super::system_names::SystemNames;
use super::{Options, Played};
use parameters::Values;
use scl_terminal::{Problem, print_err, quoted_list};
use std::ffi::OsString;
use std::path::{Path, PathBuf, absolute};
use std::time::Duration;

const LAUNCH_FILE: &str = "launch.yaml";
const TOPOLOGY_FILE: &str = "topology.yaml";
/// The variable that gives programs the name of their system.
const SYSTEM: &str = "SCL_SYSTEM";
/// The variable that tells programs which components they were started for, so that no other runs in their place.
pub(crate) const COMPONENT: &str = "SCL_COMPONENT";
/// The variable that chooses the transport of connections.
const TRANSPORT: &str = "SCL_TRANSPORT";

/// Reads the names in a topology file. If the file has errors, prints them and returns `None`.
pub type ComponentNames<'a> = &'a dyn Fn(&Path) -> Option<SystemNames>;

/// What to build, in this order, and then to start.
#[derive(Debug)]
pub(crate) struct RunPlan {
    /// The system that the programs belong to, where a topology file or `SCL_SYSTEM` names it.
    pub(crate) system: Option<String>,
    /// The topology file that the system is named after, unless it has a name of its own.
    pub(crate) named_after: Option<PathBuf>,
    pub(crate) builds: Vec<Build>,
    pub(crate) components: Vec<Component>,
    /// The program that connects this host to the others, with `--host`.
    pub(crate) gateway: Option<Component>,
    /// The program that records a simulation.
    pub(crate) recorder: Option<Component>,
}

/// The programs that each build has made, as far as cargo says so.
pub(crate) type Built = Vec<Vec<Artifact>>;

/// Returns what to build and to start for a system's folder or a launch file.
///
/// # Errors
///
/// Every reason why the system cannot be started that can be seen before it is built.
pub(crate) fn plan_run(options: &Options, component_names: ComponentNames<'_>) -> Result<RunPlan, Vec<Problem>> {
    let (folder, launch_path) = find_folder(&options.folder).map_err(|problem| vec![problem])?;
    let plan = if launch_path.is_file() {
        plan_from_launch_file(&folder, &launch_path, options, component_names)?
    } else {
        let topology = folder.join(TOPOLOGY_FILE);
        if !topology.is_file() {
            return Err(vec![nothing_to_start(&folder)]);
        }
        if let Some(profile) = options.profiles.first() {
            return Err(vec![profile_without_file(profile, &folder)]);
        }
        if options.host.is_some() {
            return Err(vec![host::without_file(&folder)]);
        }
        let names = read_names(&topology, component_names)?;
        package::plan_from_package(&folder, names, options)?
    };
    let problems = plan.check();
    if problems.is_empty() { Ok(plan) } else { Err(problems) }
}

/// Like [`plan_run`], but requires a launch file and builds nothing: programs that cargo makes must be built already.
pub(crate) fn plan_run_launch_file(
    options: &Options,
    component_names: ComponentNames<'_>,
) -> Result<RunPlan, Vec<Problem>> {
    let (folder, launch_path) = find_folder(&options.folder).map_err(|problem| vec![problem])?;
    if !launch_path.is_file() {
        let problem = Problem::new(format!("there is no `{LAUNCH_FILE}` in `{}`", folder.display()));
        return Err(vec![problem.help("give the folder of a system, or a launch file; `scl run --help` shows one")]);
    }
    let mut plan = plan_from_launch_file(&folder, &launch_path, options, component_names)?;
    let problems = plan.check();
    if !problems.is_empty() {
        return Err(problems);
    }
    plan.find_programs_built_before()?;
    Ok(plan)
}

impl RunPlan {
    /// Returns the problems that can be found before anything is built: all of them if there are no builds, otherwise
    /// those that no build can change.
    fn check(&self) -> Vec<Problem> {
        if self.builds.is_empty() {
            return self.programs().filter_map(|component| component.check().err()).collect();
        }
        let builds = self.builds.iter().map(Build::check_installed);
        let programs = self.programs().map(Component::check_installed);
        builds.chain(programs).filter_map(Result::err).collect()
    }

    /// The gateway and the recorder, if there are any, and the components: in the order in which they are started.
    pub(crate) fn programs(&self) -> impl Iterator<Item = &Component> {
        self.gateway.iter().chain(&self.recorder).chain(&self.components)
    }
}

/// Returns the topology file of a system's folder or a launch file, if there is one.
///
/// # Errors
///
/// Every reason why it cannot be found.
pub fn topology_of(place: &Path) -> Result<Option<PathBuf>, Vec<Problem>> {
    let (folder, launch_path) = find_folder(place).map_err(|problem| vec![problem])?;
    if !launch_path.is_file() {
        return Ok(Some(folder.join(TOPOLOGY_FILE)).filter(|path| path.is_file()));
    }
    let shown = launch_path.display().to_string();
    let document = LaunchDocument::parse(&shown, &read_text(&launch_path)?);
    document.check_text()?;
    find_topology(&folder, &document).map_err(|problem| vec![problem])
}

/// The system's folder, and the path of its launch file, which need not exist.
pub(crate) fn find_folder(place: &Path) -> Result<(PathBuf, PathBuf), Problem> {
    let folder = if place.is_file() { place.parent().unwrap_or(Path::new("")) } else { place };
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    // Programs run elsewhere, so their paths must not depend on our working folder.
    let folder = folder.canonicalize().map_err(|error| {
        Problem::new(format!("cannot run `{}`: {error}", place.display()))
            .help("give the folder of a system, or a launch file")
    })?;
    let launch_path = if place.is_file() { place.to_owned() } else { place.join(LAUNCH_FILE) };
    Ok((folder, launch_path))
}

fn read_names(topology: &Path, names: ComponentNames<'_>) -> Result<SystemNames, Vec<Problem>> {
    let invalid = || Problem::new("the topology has errors, so nothing was started").at(topology.display().to_string());
    names(topology).ok_or_else(|| vec![invalid()])
}

fn nothing_to_start(folder: &Path) -> Problem {
    Problem::new(format!("there is neither `{LAUNCH_FILE}` nor `{TOPOLOGY_FILE}` in `{}`", folder.display()))
        .help("give the folder of a system, or a launch file; `scl run --help` shows one")
}

fn profile_without_file(profile: &str, folder: &Path) -> Problem {
    Problem::new(format!("unknown profile `{profile}`"))
        .note(format!("profiles are in a `{LAUNCH_FILE}`, and there is none in `{}`", folder.display()))
}

fn plan_from_launch_file(
    folder: &Path,
    launch_path: &Path,
    options: &Options,
    component_names: ComponentNames<'_>,
) -> Result<RunPlan, Vec<Problem>> {
    let shown = launch_path.display().to_string();
    let text = read_text(launch_path)?;
    let document = LaunchDocument::parse(&shown, &text);
    document.check_text()?;
    let topology = find_topology(folder, &document).map_err(|problem| vec![problem])?;
    let known = topology.as_deref().map(|topology| read_names(topology, component_names)).transpose()?;
    let launch = document.read_shown(known.as_ref())?;
    let mut components = launch.components_with(&options.profiles)?;
    if let Some(played) = &options.played {
        let recording = recording_of(played).map_err(|problem| vec![problem])?;
        for component in components.iter_mut().filter(|it| played.components.contains(&it.name)) {
            (component.source, component.build) = (Source::Replay(recording.clone()), None);
        }
    }
    let mut expected = known.as_ref().map_or_else(Vec::new, |names| names.components.clone());
    let values = Values::new(options, parameters::inherited()?.as_deref(), &components, known.as_ref())?;
    let host = host::choose(&launch, options, &shown).map_err(|problem| vec![problem])?;
    if let Some(host) = host {
        components.retain(|component| host.components.contains(&component.name));
        expected.clone_from(&host.components);
    }
    if components.is_empty() && host.is_none() {
        let problem = Problem::new("the launch file has no `components`").at(&shown);
        return Err(vec![problem.help("write `components: {sensor: {command: ./sensor}}`")]);
    }
    let names = components.iter().map(|component| component.name.clone());
    let names: Vec<String> = names.chain(host.map(|_| Deployment::GATEWAY.to_owned())).collect();
    let source = host.map_or_else(|| format!("`{shown}`"), |host| format!("host `{}`", host.name));
    let selection = Selection::new(options, &names, &source)?;
    if selection.is_everything() {
        note_missing(&components, &expected);
    }
    let own_name = launch.environment.iter().rev().find(|(key, _)| key == SYSTEM).map(|(_, name)| name.clone());
    let gateway = host.filter(|_| selection.includes(Deployment::GATEWAY));
    let gateway =
        gateway.map(|host| host::plan_gateway(folder, launch_path, topology.as_deref(), &launch, host, options));
    let mut gateway = gateway.transpose().map_err(|problem| vec![problem])?;
    gateway.iter_mut().for_each(|gateway| gateway.program.environment.extend(values.cleared()));
    let chosen: Vec<LaunchComponent> = components.into_iter().filter(|it| selection.includes(&it.name)).collect();
    let unset = values.unset(&chosen);
    if !unset.is_empty() {
        return Err(unset);
    }
    let mut builds = plan_builds(folder, &launch, &chosen);
    let named_after = topology.filter(|_| own_name.is_none());
    let named_after = named_after.zip(known.as_ref()).and_then(|(file, names)| named_after_file(&file, names));
    let of_topology = || known.as_ref().map(|names| names.system.clone());
    let system = own_name.or_else(system_of_environment).or_else(of_topology);
    let plan = |component: &LaunchComponent| {
        let mut planned = plan_component(folder, &launch, component, known.as_ref(), options.grace, &mut builds);
        planned.program.environment.extend(values.variable(component));
        if matches!(component.source, Source::Command(_)) {
            planned.kept =
                KeptValues { system: system.clone(), live: values.live_of(&component.name, &component.opens) };
        }
        planned
    };
    let components = chosen.iter().map(plan).collect();
    Ok(RunPlan { system, named_after, builds, components, gateway, recorder: None })
}

fn read_text(launch_path: &Path) -> Result<String, Vec<Problem>> {
    let failed = |error| Problem::new(format!("cannot read the launch file: {error}"));
    std::fs::read_to_string(launch_path).map_err(|error| vec![failed(error).at(launch_path.display().to_string())])
}

/// The topology file that the launch file names, or the one beside it, where there is one.
fn find_topology(folder: &Path, document: &LaunchDocument) -> Result<Option<PathBuf>, Problem> {
    let Some((path, place)) = document.topology_with_place() else {
        return Ok(Some(folder.join(TOPOLOGY_FILE)).filter(|path| path.is_file()));
    };
    let path: PathBuf = folder.join(path);
    if path.is_file() {
        return Ok(Some(path));
    }
    Err(Problem::new(format!("the topology file does not exist: `{}`", path.display())).at(place))
}

/// Prints a note about components that the launch file omits. They may be started elsewhere (another terminal, a
/// replay).
fn note_missing(launched: &[LaunchComponent], components: &[String]) {
    let is_launched = |name: &String| launched.iter().any(|it| it.name == *name || it.opens.names(name));
    let missing: Vec<&str> = components.iter().filter(|name| !is_launched(name)).map(String::as_str).collect();
    if !missing.is_empty() {
        print_err(&format!("note: not in the launch file, so not started: {}\n", quoted_list(missing)));
    }
}

/// The builds in file order. Equal commands in the same folder become one.
fn plan_builds(folder: &Path, launch: &LaunchFile, components: &[LaunchComponent]) -> Vec<Build> {
    let program = |command, folder| build_program(launch, command, folder);
    let mut builds = Vec::new();
    if let Some(command) = &launch.build {
        let program = program(command, folder.to_owned());
        builds.push(Build { components: Vec::new(), program, cargo_choices: None });
    }
    for component in components {
        let Some(command) = &component.build else { continue };
        let program = program(command, folder_of(folder, &settings_of(launch, component)));
        match builds.iter_mut().find(|build: &&mut Build| build.program == program) {
            // The build of the whole system is the same command, so it covers this component.
            Some(build) if build.components.is_empty() => {}
            Some(build) => build.components.push(component.name.clone()),
            None => builds.push(Build { components: vec![component.name.clone()], program, cargo_choices: None }),
        }
    }
    builds
}

fn build_program(launch: &LaunchFile, command: &[String], folder: PathBuf) -> Program {
    // Lets a build call `scl generate` even if `scl` is not installed, or another version is.
    let scl = std::env::current_exe().ok().and_then(|path| Some(("SCL".to_owned(), path.to_str()?.to_owned())));
    let environment = scl.iter().chain(&launch.environment).cloned().collect();
    Program { environment, ..Program::new(command.iter().map(OsString::from).collect(), folder) }
}

/// Plans the program of a component. If cargo makes the program, its build is added to `builds`.
fn plan_component(
    folder: &Path,
    launch: &LaunchFile,
    component: &LaunchComponent,
    known: Option<&SystemNames>,
    grace: Duration,
    builds: &mut Vec<Build>,
) -> Component {
    let settings = settings_of(launch, component);
    let cargo = match &component.source {
        Source::Command(words) => CargoRun::parse(words),
        Source::Replay(_) => None,
    };
    let made_by_cargo = cargo.as_ref().map(|cargo| {
        let program = build_program(launch, &cargo.build, folder_of(folder, &settings));
        cargo_builds::add(builds, program, &component.name, cargo)
    });
    let (command, recording) = match &component.source {
        Source::Command(words) => {
            let program = cargo.map(|cargo| [vec![cargo.build[0].clone()], cargo.arguments].concat());
            (program.as_ref().unwrap_or(words).iter().map(OsString::from).collect(), None)
        }
        Source::Replay(path) => (replay_command(path, &component.name), Some(PathBuf::from(path))),
    };
    let expected =
        component.expected(known.map(|names| names.system.as_str())).map(|expected| (COMPONENT.to_owned(), expected));
    let own = component.environment.iter().cloned();
    let program = Program {
        command,
        environment: expected.into_iter().chain(environment_of_programs(launch)).chain(own).collect(),
        folder: folder_of(folder, &settings),
        placement: Placement {
            cpu: settings.cpu.clone().unwrap_or_default(),
            fifo: settings.priority,
            descriptors: settings.descriptors,
        },
        input: component.input,
    };
    Component {
        name: component.name.clone(),
        kind: known.and_then(|names| names.kind_of(&component.name)).map(str::to_owned),
        program,
        policy: settings.policy(grace),
        recording,
        made_by_cargo,
        entry: Some(component.place.clone()),
        kept: KeptValues::default(),
    }
}

/// The variables of all programs.
fn environment_of_programs(launch: &LaunchFile) -> impl Iterator<Item = (String, String)> {
    let inherited = std::env::var(TRANSPORT).ok();
    let transport = launch.transports.variable(inherited.as_deref()).map(|value| (TRANSPORT.to_owned(), value));
    transport.into_iter().chain(launch.environment.iter().cloned())
}

/// Returns the command that plays a component from a recording. It is executed by `scl __start`, where [`THIS_PROGRAM`]
/// is the running `scl`, too.
fn replay_command(recording: &str, component: &str) -> Vec<OsString> {
    [THIS_PROGRAM, "replay", recording, "--as", component].map(OsString::from).to_vec()
}

/// The path of a recording, for a program that runs in another folder.
fn recording_of(played: &Played) -> Result<String, Problem> {
    let shown = played.recording.display();
    let path = absolute(&played.recording).map_err(|error| Problem::new(format!("cannot use `{shown}`: {error}")))?;
    path.into_os_string().into_string().map_err(|_| Problem::new(format!("the path `{shown}` is not UTF-8")))
}

fn settings_of(launch: &LaunchFile, component: &LaunchComponent) -> Settings {
    component.settings.clone().over(&launch.defaults)
}

fn folder_of(folder: &Path, settings: &Settings) -> PathBuf {
    settings.working_directory.as_ref().map_or_else(|| folder.to_owned(), |own| folder.join(own))
}

/// The absolute path of the topology file, if the system is named after it.
fn named_after_file(topology: &Path, names: &SystemNames) -> Option<PathBuf> {
    let is_named = names.is_named || system_of_environment().is_some();
    if is_named { None } else { topology.canonicalize().ok() }
}

fn system_of_environment() -> Option<String> {
    std::env::var(SYSTEM).ok().filter(|name| !name.is_empty())
}
