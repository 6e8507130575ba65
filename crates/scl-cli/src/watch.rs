//! `scl watch`: the live picture of a running system, in a browser.

use crate::load::{MaxSize, TOPOLOGY, load_file, show_errors};
use crate::observed::SystemArgument;
use clap::Args;
use scl_observe::{StopSignals, System, block_on};
use scl_plan::SystemPlan;
use scl_terminal::{Problem, output_is_closed, print_out};
use scl_watch::{Server, picture};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Show a running system as a live picture in a browser: which programs run, what flows between them, what is wrong.
///
/// Prints the address of the page, and serves it until it is stopped. The page is for this machine and for those who
/// know the whole address: it contains a token. Nothing is read while no page is open, and components notice nothing.
///
/// A click at a gate shows its last message, and a plot of a field; a click at a component its process and parameters.
/// From another machine: `ssh -L 8080:127.0.0.1:8080 board scl watch --port 8080`.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl watch                             open the address that it prints
  scl watch --system rover --port 8080
  scl watch --svg > now.svg             the picture of this moment, as a file

Exit code: 0 shown, or stopped with Ctrl-C, 2 no such system, or the port is in use.")]
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
    #[arg(long, conflicts_with = "port")]
    svg: bool,
}

/// The body of `scl watch`.
pub(crate) fn watch(arguments: &WatchArguments) -> Result<ExitCode, Problem> {
    let system = System::find_or_await(arguments.system.name())?;
    let file = plan_of_file(arguments.topology.as_deref(), system.name())?;
    if arguments.svg {
        print_out(&picture(&system, file));
        return Ok(ExitCode::SUCCESS);
    }
    block_on(async {
        let mut stop = StopSignals::watch()?;
        let server = Server::bind(([127, 0, 0, 1], arguments.port).into(), system, file).await;
        let server = server.map_err(|error| {
            Problem::new(format!("cannot listen at 127.0.0.1:{}: {error}", arguments.port))
                .help("choose another port with `--port`, or none for any that is free")
        })?;
        print_out(&format!("{}\n", server.url()));
        if output_is_closed() {
            return Ok(ExitCode::SUCCESS);
        }
        tokio::select! {
            () = server.serve() => {}
            () = stop.received() => {}
        }
        Ok(ExitCode::SUCCESS)
    })
}

/// The plan of the system in a topology file; that of the working folder need not exist, or be of this system.
fn plan_of_file(file: Option<&Path>, system: &str) -> Result<Option<SystemPlan>, Problem> {
    let path = file.unwrap_or(Path::new(TOPOLOGY));
    if file.is_none() && !path.is_file() {
        return Ok(None);
    }
    let loaded = load_file(path, MaxSize::default());
    match loaded.system_plan() {
        Some(plan) if plan.system == system => Ok(Some(plan)),
        Some(plan) if file.is_some() => {
            Err(Problem::new(format!("`{}` is of the system `{}`, not of `{system}`", path.display(), plan.system))
                .help(format!("choose it with `--system {}`", plan.system)))
        }
        None if file.is_some() => {
            show_errors(&loaded);
            Err(Problem::new(format!("`{}` has errors", path.display())))
        }
        _ => Ok(None),
    }
}
