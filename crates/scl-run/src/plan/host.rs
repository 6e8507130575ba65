//! `--host`: the components of one host, and the gateway that connects them to the others.

use super::super::Options;
use super::super::component::Component;
use super::super::deployment::{Deployment, Host};
use super::super::gateway_program;
use super::super::kept_values::KeptValues;
use super::super::launch_file::{LaunchDocument, LaunchFile};
use super::super::policy::{Policy, Restart, RestartLimit};
use super::super::program::Program;
use super::{ComponentNames, LAUNCH_FILE, environment_of_programs, find_folder, find_topology, read_names, read_text};
use scl_terminal::{Problem, print_err};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A system on several hosts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeployedSystem {
    /// Its topology file.
    pub topology: PathBuf,
    /// Its hosts. The folder of the certificates is an absolute path.
    pub deployment: Deployment,
}

/// Reads the hosts of a launch file; `topology` overrides the topology file that the launch file names.
///
/// # Errors
///
/// Every mistake of the launch file; also if it has no hosts or there is no topology file.
pub fn read_deployment(
    launch: &Path,
    topology: Option<&Path>,
    component_names: ComponentNames<'_>,
) -> Result<DeployedSystem, Vec<Problem>> {
    let (folder, launch_path) = find_folder(launch).map_err(|problem| vec![problem])?;
    let shown = launch_path.display().to_string();
    let text = read_text(&launch_path)?;
    let document = LaunchDocument::parse(&shown, &text);
    document.check_text()?;
    let topology = match topology {
        Some(topology) => Some(topology.to_owned()),
        None => find_topology(&folder, &document).map_err(|problem| vec![problem])?,
    };
    let topology = topology.ok_or_else(|| vec![no_topology(&shown)])?;
    let known = read_names(&topology, component_names)?;
    let launch = document.read_shown(Some(&known))?;
    let mut deployment = launch.deployment.ok_or_else(|| vec![no_hosts(&shown)])?;
    deployment.certificates = deployment.certificates.map(|path| folder.join(path));
    Ok(DeployedSystem { topology, deployment })
}

/// Returns the host of `--host`, or `None` without the option. In that case prints a note if the launch file has hosts,
/// because the option may have been forgotten.
pub(super) fn choose<'l>(launch: &'l LaunchFile, options: &Options, shown: &str) -> Result<Option<&'l Host>, Problem> {
    match (&options.host, &launch.deployment) {
        (None, None) => Ok(None),
        (None, Some(_)) => {
            print_err("note: without `--host`, the components of all hosts run on this machine, without gateways\n");
            Ok(None)
        }
        (Some(_), None) => Err(no_hosts(shown)),
        (Some(name), Some(deployment)) => match deployment.host(name) {
            Some(host) => Ok(Some(host)),
            None => Err(deployment.unknown_host(name).at(shown)),
        },
    }
}

/// The program that connects a host to the others. It is started again whenever it ends: components go on without it,
/// and nothing else brings the connections back.
pub(super) fn plan_gateway(
    folder: &Path,
    launch_path: &Path,
    topology: Option<&Path>,
    launch: &LaunchFile,
    host: &Host,
    options: &Options,
) -> Result<Component, Problem> {
    let topology = topology.ok_or_else(|| no_topology(&launch_path.display().to_string()))?;
    // The gateway runs in `folder`, so a path relative to the current folder must be made absolute.
    let launch_file = launch_path.file_name().map_or_else(|| launch_path.to_owned(), |name| folder.join(name));
    let files = [("--topology", topology), ("--launch", &launch_file)];
    let files = files.into_iter().flat_map(|(option, path)| [OsString::from(option), path.as_os_str().to_owned()]);
    let program = gateway_program::find()?.into_os_string();
    let command = [program, "run".into()].into_iter().chain(files).chain(["--host".into(), (&host.name).into()]);
    let limit = RestartLimit { count: usize::MAX, within: Duration::from_secs(60) };
    Ok(Component {
        name: Deployment::GATEWAY.to_owned(),
        kind: None,
        program: Program {
            environment: environment_of_programs(launch).collect(),
            ..Program::new(command.collect(), folder.to_owned())
        },
        policy: Policy {
            restart: Restart::Always,
            limit,
            essential: false,
            stop_within: options.grace,
            ..Policy::default()
        },
        recording: None,
        made_by_cargo: None,
        entry: None,
        kept: KeptValues::default(),
    })
}

/// The problem of `--host` without a launch file.
pub(super) fn without_file(folder: &Path) -> Problem {
    Problem::new("`--host` needs a launch file")
        .help("write one with `hosts`; `scl run --help` shows it")
        .note(format!("there is no `{LAUNCH_FILE}` in `{}`", folder.display()))
}

fn no_hosts(shown: &str) -> Problem {
    Problem::new("the launch file has no `hosts`")
        .at(shown)
        .help("write `hosts: {board: {address: 192.0.2.10, components: [sensor]}}` and `gateway: {port: 7447}`")
}

fn no_topology(shown: &str) -> Problem {
    Problem::new("a system on several hosts needs its topology file")
        .at(shown)
        .help("write `topology: ../topology.yaml`, or put `topology.yaml` beside the launch file")
}
