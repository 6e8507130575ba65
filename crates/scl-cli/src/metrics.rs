//! `scl metrics`: the figures of systems for Prometheus.

use crate::observed::SystemArgument;
use crate::serving::{cannot_listen, serve_until_stopped};
use clap::Args;
use scl_observe::{StopSignals, System, block_on};
use scl_terminal::{Problem, print_out};
use scl_watch::{DASHBOARD, MetricsServer, metrics as text_of};
use std::net::SocketAddr;
use std::process::ExitCode;

/// Give the figures of components, gates and connections to Prometheus, Grafana and OpenTelemetry collectors.
///
/// Without options, they are printed once, in the text format of Prometheus. With `--listen`, they are served under
/// `/metrics` until the command is stopped; systems that start later appear. Everything is read from the files that
/// components write twice a second, when somebody asks.
///
/// The figures contain no messages, but anyone who can reach the address can read them.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl metrics --listen 127.0.0.1:9464           for a Prometheus or a collector on this machine
  scl metrics --listen 0.0.0.0:9464             for others, too
  scl metrics > /var/lib/node/scl.prom          for the textfile collector of node_exporter
  scl metrics --dashboard > scl.json            a dashboard, to import into Grafana

Exit code: 0 shown, or stopped with Ctrl-C, 2 no such system, or the address is in use.")]
pub(crate) struct MetricsArguments {
    #[command(flatten)]
    system: SystemArgument,
    /// Serve the figures at this address, for example 127.0.0.1:9464.
    #[arg(long, value_name = "ADDRESS")]
    listen: Option<SocketAddr>,
    /// Print a dashboard for Grafana, as JSON.
    #[arg(long, conflicts_with_all = ["listen", "system"])]
    dashboard: bool,
}

/// The body of `scl metrics`.
pub(crate) fn metrics(arguments: &MetricsArguments) -> Result<ExitCode, Problem> {
    if arguments.dashboard {
        print_out(DASHBOARD);
        return Ok(ExitCode::SUCCESS);
    }
    let Some(address) = arguments.listen else {
        print_out(&text_of(&System::find_all(arguments.system.name())?));
        return Ok(ExitCode::SUCCESS);
    };
    let named = arguments.system.name().map(|name| System::find_or_await(Some(name))).transpose()?;
    block_on(async {
        let mut stop = StopSignals::watch()?;
        let server = MetricsServer::bind(address, named).await;
        let server = server.map_err(cannot_listen(address, "choose an address of this machine, with another port"))?;
        Ok(serve_until_stopped(&server.url(), server.serve(), &mut stop).await)
    })
}
