//! `scl gateway keys`: certificates for the hosts of a launch file.

use crate::files::{FileArguments, find_host, show, with_cause};
use clap::Args;
use scl_gateway::deployment::{Host, System};
use scl_gateway::keys::{Issued, KeysError, Wanted, issue};
use scl_terminal::{Problem, print_out, timestamp};
use std::path::Path;
use std::process::ExitCode;
use std::time::SystemTime;

/// Make a certificate authority, and a certificate for each host.
///
/// Writes them into the folder that `certificates` of `gateway` names in the launch file: a folder for the authority,
/// which stays there, and one for each host, to be copied to that host. Existing files are kept, so hosts can be added
/// later.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl gateway keys                          for all hosts that have none
  scl gateway keys --host board --force     a new certificate for the board; the others stay valid
  scl gateway keys --force                  replace everything: all hosts need their new folders

Exit code: 0 done, 2 could not be made.")]
pub(crate) struct KeysArguments {
    #[command(flatten)]
    files: FileArguments,
    /// Only for this host; may be repeated.
    #[arg(long = "host", value_name = "HOST")]
    hosts: Vec<String>,
    /// How many days the certificates of the hosts are valid.
    #[arg(long, value_name = "DAYS", default_value_t = 730, value_parser = clap::value_parser!(u32).range(1..=36500))]
    days: u32,
    /// Replace existing files: with `--host` the certificates of these hosts, otherwise all, including the authority.
    #[arg(long)]
    force: bool,
}

/// The body of `scl gateway keys`.
pub(crate) fn make_keys(arguments: &KeysArguments) -> ExitCode {
    match arguments.files.load().and_then(|system| make(arguments, &system)) {
        Some(()) => ExitCode::SUCCESS,
        None => ExitCode::from(2),
    }
}

fn make(arguments: &KeysArguments, system: &System) -> Option<()> {
    let Some(folder) = &system.deployment.certificates else {
        let problem = Problem::new("`gateway` in the launch file has no `certificates`");
        show(&problem.help("write `gateway: {port: 7447, certificates: ./keys}`"));
        return None;
    };
    let hosts: Option<Vec<&Host>> = match arguments.hosts.as_slice() {
        [] => Some(system.deployment.hosts.iter().collect()),
        names => names.iter().map(|name| find_host(system, name)).collect(),
    };
    let wanted = Wanted {
        system: &system.plan.system,
        hosts: hosts?,
        days: arguments.days,
        replace_hosts: arguments.force,
        replace_authority: arguments.force && arguments.hosts.is_empty(),
        now: SystemTime::now(),
    };
    match issue(folder, &wanted) {
        Ok(issued) => {
            print_out(&report(&issued, folder));
            Some(())
        }
        Err(error) => {
            show(&explained(&error));
            None
        }
    }
}

/// Reports which folder goes to which host, and when its certificate expires.
fn report(issued: &[Issued], folder: &Path) -> String {
    let line = |it: &Issued| {
        let what = if it.is_new { "new" } else { "kept" };
        let expires = it.expires.map_or_else(|| "cannot be read".to_owned(), |at| format!("expires {}", date(at)));
        let (folder, purpose) = (
            it.folder.display(),
            match &it.host {
                None => "the authority: keep it here, and secret".to_owned(),
                Some(host) => format!("copy this folder to host `{host}`"),
            },
        );
        format!("{what:<4}  {folder}  {expires}; {purpose}\n")
    };
    let lines: String = issued.iter().map(line).collect();
    let folder = folder.display();
    format!("{lines}\nOn each host, put its folder beside the launch file as here: into `{folder}`.\n")
}

fn date(time: SystemTime) -> String {
    timestamp(time).split('T').next().unwrap_or_default().to_owned()
}

fn explained(error: &KeysError) -> Problem {
    let problem = with_cause(error);
    match error {
        KeysError::NoAuthorityKey { .. } => problem
            .help("run this where the authority was made")
            .help("or replace everything: `scl gateway keys --force`"),
        KeysError::Authority { .. } | KeysError::AuthorityExpired { .. } => {
            problem.help("replace everything: `scl gateway keys --force`")
        }
        _ => problem,
    }
}
