//! `scl deploy`: the files by which a service manager runs a system.

use crate::run::component_names;
use clap::{Args, Subcommand};
use scl_plan::Assignment;
use scl_run::{Unit, UnitOptions, systemd_units};
use scl_terminal::{Problem, parse_duration, print_out};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Write the files by which a service manager runs a system, in place of `scl run`.
#[derive(Args)]
pub(crate) struct DeployArguments {
    #[command(subcommand)]
    manager: Manager,
}

#[derive(Subcommand)]
enum Manager {
    Systemd(SystemdArguments),
}

/// Write systemd unit files: a service for each component and for the gateway, and a target for all of them. The
/// components of a kind share a template, `rover-motor@.service`.
///
/// To be run on the machine where the services will run: the files contain the absolute paths of the programs here.
/// Builds are not run.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl deploy systemd                               all components, into ./systemd
  scl deploy systemd --host board --user rover     the components of a host and its gateway
  sudo cp systemd/* /etc/systemd/system/ && sudo systemctl daemon-reload
  sudo systemctl enable --now rover.target

Exit code: 0 written, 2 nothing was written.")]
pub(crate) struct SystemdArguments {
    /// The system's folder, or a launch file.
    #[arg(default_value = ".")]
    folder: PathBuf,
    /// The components of this host of the launch file, and its gateway to the other hosts.
    #[arg(long, value_name = "HOST")]
    host: Option<String>,
    /// Use the programs of this profile of the launch file; several: later ones win.
    #[arg(long = "profile", value_name = "NAME")]
    profiles: Vec<String>,
    /// Give a parameter this value, for example `controller.gain=2`; wins over the launch file. May be repeated.
    #[arg(long, value_name = "COMPONENT.PARAMETER=VALUE", value_parser = Assignment::parse)]
    set: Vec<Assignment>,
    /// The user of all services [default: root].
    #[arg(long, value_name = "USER")]
    user: Option<String>,
    /// The folder to write to.
    #[arg(long, short, value_name = "FOLDER", default_value = "systemd")]
    output: PathBuf,
    /// How long components without a `stop_within` in the launch file may take to stop before they are killed.
    #[arg(long, value_name = "TIME", default_value = "5s", value_parser = parse_duration)]
    grace: Duration,
}

/// The body of `scl deploy`.
pub(crate) fn deploy(arguments: &DeployArguments) -> Result<ExitCode, Vec<Problem>> {
    let Manager::Systemd(arguments) = &arguments.manager;
    let run = scl_run::Options {
        folder: arguments.folder.clone(),
        profiles: arguments.profiles.clone(),
        host: arguments.host.clone(),
        set: arguments.set.clone(),
        grace: arguments.grace,
        ..scl_run::Options::default()
    };
    let options = UnitOptions { run, user: arguments.user.clone() };
    let units = systemd_units(&options, &component_names)?;
    write(&arguments.output, &units).map(|()| ExitCode::SUCCESS).map_err(|problem| vec![problem])
}

fn write(folder: &Path, units: &[Unit]) -> Result<(), Problem> {
    let failed = |path: &Path, error| Problem::new(format!("cannot write `{}`: {error}", path.display()));
    fs::create_dir_all(folder).map_err(|error| failed(folder, error))?;
    for unit in units {
        let path = folder.join(&unit.name);
        fs::write(&path, &unit.text).map_err(|error| failed(&path, error))?;
        print_out(&format!("{}\n", path.display()));
    }
    Ok(())
}
