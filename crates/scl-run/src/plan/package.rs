//! Without a launch file: the programs of the cargo package beside the topology.

use super::super::Options;
use super::super::cargo::{Target, cargo};
use super::super::component::{Component, MadeByCargo};
use super::super::kept_values::KeptValues;
use super::super::launch_file::Opens;
use super::super::policy::Policy;
use super::super::program::{Build, Program};
use super::super::selection::Selection;
use super::parameters::{self, Values};
use super::{COMPONENT, RunPlan, SystemNames, TOPOLOGY_FILE, named_after_file, system_of_environment};
use super::{recording_of, replay_command};
use scl_terminal::Problem;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Plans the build of the package and, for each component, the program with its name or with the name of its kind.
///
/// # Errors
///
/// If there is no package, or no component is chosen.
pub(super) fn plan_from_package(folder: &Path, names: SystemNames, options: &Options) -> Result<RunPlan, Vec<Problem>> {
    let source = format!("`{}`", folder.join(TOPOLOGY_FILE).display());
    let selection = Selection::new(options, &names.components, &source)?;
    if !folder.join("Cargo.toml").is_file() {
        let problem = Problem::new(format!("there is no cargo package in `{}`", folder.display()));
        let help = "add a `launch.yaml` that says how each component is started; `scl run --help` shows one";
        return Err(vec![problem.help(help)]);
    }
    let started: Vec<&String> = names.components.iter().filter(|name| selection.includes(name)).collect();
    let values = Values::new(options, parameters::inherited()?.as_deref(), &[], Some(&names))?;
    let unset: Vec<Problem> = started.iter().flat_map(|name| values.unset_of(name, None)).collect();
    if !unset.is_empty() {
        return Err(unset);
    }
    let program = |command| Program::new(command, folder.to_owned());
    let release = options.release.then(|| OsString::from("--release"));
    let build = [cargo(), "build".into(), "--bins".into()].into_iter().chain(release).collect();
    let expected = |name: &String| (COMPONENT.to_owned(), format!("{}.{name}", names.system));
    let system = system_of_environment().or(Some(names.system.clone()));
    let plan = |name: &&String| Component {
        name: (*name).clone(),
        kind: names.kind_of(name).map(str::to_owned),
        program: Program {
            environment: [expected(name)].into_iter().chain(values.variable_of(name, &Opens::Own)).collect(),
            ..program(vec![cargo()])
        },
        policy: Policy { stop_within: options.grace, ..Policy::default() },
        recording: None,
        made_by_cargo: Some(MadeByCargo {
            build: 0,
            target: Target::OfComponent { name: (*name).clone(), kind: names.kind_of(name).map(str::to_owned) },
        }),
        entry: None,
        kept: KeptValues { system: system.clone(), live: values.live_of(name, &Opens::Own) },
    };
    Ok(RunPlan {
        system: system.clone(),
        named_after: named_after_file(&folder.join(TOPOLOGY_FILE), &names),
        builds: vec![Build { components: Vec::new(), program: program(build), cargo_choices: Some(Vec::new()) }],
        components: play(started.iter().map(plan).collect(), options)?,
        gateway: None,
        recorder: None,
    })
}

/// Replaces the programs of components that a recording plays.
fn play(mut components: Vec<Component>, options: &Options) -> Result<Vec<Component>, Vec<Problem>> {
    let Some(played) = &options.played else { return Ok(components) };
    let recording = recording_of(played).map_err(|problem| vec![problem])?;
    for component in components.iter_mut().filter(|it| played.components.contains(&it.name)) {
        component.program.command = replay_command(&recording, &component.name);
        component.recording = Some(PathBuf::from(&recording));
        component.made_by_cargo = None;
    }
    Ok(components)
}
