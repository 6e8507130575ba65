//! The files that all commands read: launch file and topology, and the certificates of a host.

use clap::Args;
use scl_gateway::deployment::{Host, System};
use scl_gateway::keys::{self, HostFiles, KeyProblem};
use scl_terminal::{Problem, print_err, timestamp};
use std::error::Error;
use std::path::PathBuf;
use std::time::{Duration, SystemTime};

/// Certificates that expire within this time are reported to the user.
const SOON: Duration = Duration::from_secs(30 * 24 * 3600);

/// Which files.
#[derive(Args)]
pub(crate) struct FileArguments {
    /// The launch file with the hosts, or its folder.
    #[arg(long, value_name = "FILE", default_value = ".")]
    pub(crate) launch: PathBuf,
    /// The topology file, if it is not the one that the launch file names.
    #[arg(long, value_name = "FILE")]
    pub(crate) topology: Option<PathBuf>,
}

impl FileArguments {
    /// Reads the launch file and the topology file. Prints all errors and returns `None` if they have any.
    pub(crate) fn load(&self) -> Option<System> {
        match System::load(&self.launch, self.topology.as_deref()) {
            Ok(system) => Some(system),
            Err(texts) => {
                texts.iter().for_each(|text| print_err(&format!("{text}\n")));
                None
            }
        }
    }
}

/// Returns the host with this name. Prints an error and returns `None` if there is none.
pub(crate) fn find_host<'s>(system: &'s System, name: &str) -> Option<&'s Host> {
    let host = system.deployment.host(name);
    if host.is_none() {
        show(&system.deployment.unknown_host(name));
    }
    host
}

/// Checks and returns the certificate files of a host; `None` if the system has no certificates. Prints all problems
/// and returns an error if there are any.
pub(crate) fn check_certificates(system: &System, host: &Host) -> Result<Option<HostFiles>, ()> {
    let Some(folder) = &system.deployment.certificates else { return Ok(None) };
    let files = HostFiles::of(folder, &host.name);
    let now = SystemTime::now();
    match keys::check(&files, host, now) {
        Ok(expires) => {
            if expires < now + SOON {
                let at = timestamp(expires);
                print_err(&format!("note: the certificate of host `{}` expires on {at}\n", host.name));
            }
            Ok(Some(files))
        }
        Err(problems) => {
            problems.iter().for_each(|problem| show(&explained(problem, &host.name)));
            Err(())
        }
    }
}

pub(crate) fn show(problem: &Problem) {
    print_err(&format!("{problem}\n"));
}

/// Adds help to a problem: how to solve it.
fn explained(problem: &KeyProblem, host: &str) -> Problem {
    let renew = format!("make a new one: `scl gateway keys --host {host} --force`, and copy its folder to the host");
    let copy = || "run `scl gateway keys` on one machine, and copy the host's folder from there".to_owned();
    let help = match problem {
        KeyProblem::NoFolder { .. } | KeyProblem::Missing { .. } => copy(),
        KeyProblem::Exposed { path, .. } => format!("run `chmod 600 '{}'`", path.display()),
        KeyProblem::NotYetValid { .. } => "set the clock of this machine".to_owned(),
        KeyProblem::OtherHost { found, .. } => {
            format!("copy the folder of host `{host}` here, and that of `{found}` to its own host")
        }
        KeyProblem::Unreadable { .. } => "make the user who runs the gateway the owner of the file".to_owned(),
        KeyProblem::Foreign { .. } => {
            "copy all three files of the host from the machine with the authority; `scl gateway keys` made them together"
                .to_owned()
        }
        _ => renew,
    };
    with_cause(problem).help(help)
}

/// Converts an error into a problem, with the error's cause as a note.
pub(crate) fn with_cause(error: &dyn Error) -> Problem {
    let problem = Problem::new(error.to_string());
    error.source().into_iter().fold(problem, |problem, cause| problem.note(cause.to_string()))
}
