//! Without a launch file: the programs of the cargo package beside the topology.

use super::super::Options;
use super::super::cargo_package::{BuiltProgram, build_package};
use super::super::placement::Placement;
use super::super::policy::Policy;
use super::super::program::{Component, Program};
use super::super::selection::Selection;
use super::{LAUNCH_FILE, RunPlan, SystemNames, TOPOLOGY_FILE, system_of_environment};
use scl_terminal::{Problem, quoted_list};
use std::path::Path;

/// Builds the package and finds the program of each component.
///
/// # Errors
///
/// Everything that is missing.
pub(super) fn plan_from_package(folder: &Path, names: SystemNames, options: &Options) -> Result<RunPlan, Vec<Problem>> {
    let source = format!("`{}`", folder.join(TOPOLOGY_FILE).display());
    let selection = Selection::new(options, &names.components, &source)?;
    let components: Vec<&String> = names.components.iter().filter(|name| selection.includes(name)).collect();
    let built = build_package(folder, options.release).map_err(|problem| vec![problem])?;
    let program_of = |name: &String| built.iter().find(|program| plays(program, name));
    let missing = components.iter().filter(|name| program_of(name).is_none());
    let missing: Vec<&str> = missing.map(|name| name.as_str()).collect();
    if !missing.is_empty() {
        return Err(vec![missing_programs(folder, &missing, &built)]);
    }
    let plan = |(name, built): (&String, &BuiltProgram)| Component {
        name: name.clone(),
        program: Program {
            command: vec![built.executable.clone().into_os_string()],
            environment: Vec::new(),
            folder: folder.to_owned(),
            placement: Placement::default(),
        },
        policy: Policy { stop_within: options.grace, ..Policy::default() },
        recording: None,
    };
    let programs = components.iter().filter_map(|name| Some((*name, program_of(name)?)));
    let components = programs.map(plan).collect();
    Ok(RunPlan {
        system: system_of_environment().or(Some(names.system)),
        builds: Vec::new(),
        components,
        gateway: None,
    })
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
