//! `scl gateway check`: checks whether a host's gateway can run with its launch file and certificates.

use crate::files::{FileArguments, check_certificates, find_host};
use clap::Args;
use scl_gateway::deployment::Host;
use scl_terminal::print_out;
use std::process::ExitCode;

/// Check the launch file and the certificates of a host.
///
/// The gateway checks the same when it starts.
#[derive(Args)]
pub(crate) struct CheckArguments {
    #[command(flatten)]
    files: FileArguments,
    /// The host; without one, all hosts.
    #[arg(long, value_name = "HOST")]
    host: Option<String>,
}

/// The body of `scl gateway check`.
pub(crate) fn check(arguments: &CheckArguments) -> ExitCode {
    let Some(system) = arguments.files.load() else { return ExitCode::from(2) };
    let hosts: Vec<&Host> = match &arguments.host {
        None => system.deployment.hosts.iter().collect(),
        Some(name) => match find_host(&system, name) {
            Some(host) => vec![host],
            None => return ExitCode::from(2),
        },
    };
    let mut is_fine = true;
    for host in hosts {
        let (name, address) = (&host.name, host.socket_address());
        match check_certificates(&system, host) {
            Ok(Some(_)) => print_out(&format!("host `{name}`: fine, at {address}\n")),
            Ok(None) => print_out(&format!("host `{name}`: without certificates, at {address}\n")),
            Err(()) => is_fine = false,
        }
    }
    if is_fine { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
