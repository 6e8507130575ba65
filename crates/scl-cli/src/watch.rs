//! `scl watch`: the live picture of a running system, in a browser.

use crate::load::{MaxSize, TOPOLOGY, load_file, show_errors};
use crate::observed::SystemArgument;
use crate::serving::{cannot_listen, serve_until_stopped};
use clap::Args;
use scl_observe::{StopSignals, System, block_on};
use scl_plan::SystemPlan;
use scl_record::recording::{Recording, find_files};
use scl_terminal::{Problem, print_out};
use scl_watch::{Server, Source, picture};
use std::env::current_exe;
use std::net::SocketAddr;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Show a running system as a live picture in a browser: which programs run, what flows between them, what is wrong.
///
/// Prints the address of the page, and serves it until it is stopped. The page is for this machine and for those who
/// know the whole address: it contains a token. Nothing is read while no page is open, and components notice nothing.
///
/// A click at a gate shows its last message, and a plot of a field; a click at a component its process, parameters and
/// log. With `--control`, the page can also act.
/// From another machine: `ssh -L 8080:127.0.0.1:8080 board scl watch --port 8080`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl watch                             open the address that it prints
  scl watch --system rover --port 8080
  scl watch --control                   with buttons to restart and stop components, set parameters, call gates
  scl watch --svg > now.svg             the picture of this moment, as a file
  scl watch --replay flight.mcap        a recording, with a slider for the time

Exit code: 0 shown, or stopped with Ctrl-C, 2 no such system or recording, or the port is in use.")]
pub(crate) struct WatchArguments {
    #[command(flatten)]
    system: SystemArgument,
    /// The topology file, which tells of components that do not run [default: topology.yaml, if it is of this system].
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    /// The port on 127.0.0.1 [default: any that is free].
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the picture of this moment as SVG, and exit.
    #[arg(long, conflicts_with_all = ["port", "control"])]
    svg: bool,
    /// Show a recording, with a slider for the time.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["svg", "control", "system"])]
    replay: Vec<PathBuf>,
    /// Let pages restart and stop components, set live parameters, and call gates.
    #[arg(long)]
    control: bool,
}

/// The body of `scl watch`.
pub(crate) fn watch(arguments: &WatchArguments) -> Result<ExitCode, Problem> {
    let source = match &arguments.replay[..] {
        [] => {
            let system = System::find_or_await(arguments.system.name())?;
            let file = plan_of_file(arguments.topology.as_deref(), system.name())?;
            if arguments.svg {
                print_out(&picture(&system, file));
                return Ok(ExitCode::SUCCESS);
            }
            let program = current_exe().unwrap_or_else(|_| "scl".into());
            Source::system(system, file, program, arguments.control)
        }
        files => recorded(files, arguments.topology.as_deref())?,
    };
    block_on(async {
        let mut stop = StopSignals::watch()?;
        let address = SocketAddr::from(([127, 0, 0, 1], arguments.port));
        let help = "choose another port with `--port`, or none for any that is free";
        let server = Server::bind(address, source).await.map_err(cannot_listen(address, help))?;
        Ok(serve_until_stopped(&server.url(), server.serve(), &mut stop).await)
    })
}

/// A recording, drawn as the plan in it says, or another topology.
fn recorded(files: &[PathBuf], topology: Option<&Path>) -> Result<Source, Problem> {
    let recording = Recording::open(&find_files(files)?)?;
    let plan = match topology {
        Some(file) => plan_of(file)?,
        None => recording.plan()?.ok_or_else(|| {
            Problem::new(format!("`{}` does not say which components there were", recording.name()))
                .help("name the topology file with `--topology`")
        })?,
    };
    Source::recording(&recording, plan)
}

/// The plan of the system in a topology file; that of the working folder need not exist, or be of this system.
fn plan_of_file(file: Option<&Path>, system: &str) -> Result<Option<SystemPlan>, Problem> {
    let Some(file) = file else {
        let here = Path::new(TOPOLOGY);
        let plan = here.is_file().then(|| load_file(here, MaxSize::default()).system_plan()).flatten();
        return Ok(plan.filter(|plan| plan.system == system));
    };
    let plan = plan_of(file)?;
    if plan.system != system {
        return Err(Problem::new(format!(
            "`{}` is of the system `{}`, not of `{system}`",
            file.display(),
            plan.system
        ))
        .help(format!("choose it with `--system {}`", plan.system)));
    }
    Ok(Some(plan))
}

/// The plan of a topology file.
fn plan_of(file: &Path) -> Result<SystemPlan, Problem> {
    let loaded = load_file(file, MaxSize::default());
    loaded.system_plan().ok_or_else(|| {
        show_errors(&loaded);
        Problem::new(format!("`{}` has errors", file.display()))
    })
}
