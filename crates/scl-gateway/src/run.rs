//! `scl gateway run`: runs the gateway of a host until SIGTERM or SIGINT.

use crate::files::{FileArguments, check_certificates, find_host, show};
use crate::log;
use crate::one_thread;
use clap::Args;
use rustix::process::{Resource, Rlimit, getrlimit, setrlimit};
use scl::host::{tell_service_manager, text_with_causes};
use scl::runtime_dir::{RuntimeDir, SystemDir};
use scl::{TransportChoice, TransportKind};
use scl_gateway::deployment::{Host, System};
use scl_gateway::keys::HostFiles;
use scl_gateway::local::Gateway;
use scl_gateway::route::routes;
use scl_gateway::wire::{Peer, Wire, WireOptions};
use scl_terminal::{Problem, problem_of};
use std::path::PathBuf;
use std::process::ExitCode;
use tokio::signal::unix::{SignalKind, signal};

/// Run the gateway of a host until SIGTERM or SIGINT.
///
/// `scl run --host` starts it automatically.
#[derive(Args)]
pub(crate) struct RunArguments {
    #[command(flatten)]
    files: FileArguments,
    /// The host whose gateway to run.
    #[arg(long, value_name = "HOST")]
    host: String,
    /// The runtime folder of the components, as in `SCL_RUNTIME_DIR`.
    #[arg(long, value_name = "FOLDER")]
    runtime_dir: Option<PathBuf>,
}

/// The body of `scl gateway run`.
pub(crate) fn run(arguments: &RunArguments) -> ExitCode {
    match try_run(arguments) {
        Some(()) => ExitCode::SUCCESS,
        None => ExitCode::from(2),
    }
}

/// Runs the gateway. Prints problems and returns `None` if it cannot run.
fn try_run(arguments: &RunArguments) -> Option<()> {
    shown(one_thread::ensure())?;
    shown(log::start())?;
    raise_descriptor_limit();
    let system = arguments.files.load()?;
    let host = find_host(&system, &arguments.host)?;
    let certificates = check_certificates(&system, host).ok()?;
    let dir = shown(system_dir(arguments, &system))?;
    let kind = shown(transport_kind())?;
    let wire = wire_options(&system, host, certificates);
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build();
    let runtime = shown(runtime.map_err(|error| Problem::new(format!("cannot start the runtime: {error}"))))?;
    shown(runtime.block_on(serve(dir, kind, wire)))
}

async fn serve(dir: SystemDir, kind: TransportKind, wire: WireOptions) -> Result<(), Problem> {
    let signals = |error| Problem::new(format!("cannot handle signals: {error}"));
    let mut terminate = signal(SignalKind::terminate()).map_err(signals)?;
    let mut interrupt = signal(SignalKind::interrupt()).map_err(signals)?;
    let status = match (&wire.listen, wire.peers.as_slice()) {
        (Some(address), [_, ..]) => format!("STATUS=listening on {address}"),
        _ => "STATUS=no connection crosses to another host".to_owned(),
    };
    let wire = Wire::open(wire).await.map_err(|error| problem_of(&error))?;
    let gateway = Gateway::start(dir, kind, wire);
    tell_service_manager(&format!("{status}\nREADY=1\n"));
    tokio::select! {
        _ = terminate.recv() => {}
        _ = interrupt.recv() => {}
    }
    tell_service_manager("STOPPING=1\n");
    gateway.close().await;
    Ok(())
}

fn wire_options(system: &System, host: &Host, files: Option<HostFiles>) -> WireOptions {
    let routes = routes(&system.plan, &system.deployment, &host.name);
    let shares_routes = |other: &&Host| routes.iter().any(|it| it.from.host == other.name || it.to.host == other.name);
    let others = system.deployment.hosts.iter().filter(|other| other.name != host.name).filter(shares_routes);
    let peer = |other: &Host| Peer { host: other.name.clone(), address: Some(other.socket_address()) };
    WireOptions {
        system: system.plan.system.clone(),
        host: host.name.clone(),
        listen: Some(host.socket_address()),
        peers: others.map(peer).collect(),
        tls: files,
        insecure: system.deployment.insecure,
        components: system.hosts_of_components(),
        routes,
    }
}

/// Raises the limit of open files as far as this program may. Each connection of a component takes a descriptor, and so
/// does each link.
fn raise_descriptor_limit() {
    let limit = getrlimit(Resource::Nofile);
    if let Err(error) = setrlimit(Resource::Nofile, Rlimit { current: limit.maximum, ..limit }) {
        tracing::debug!(%error, ?limit, "cannot raise the limit of open files");
    }
}

/// Returns the folder of the system on this host, from the arguments and the environment.
fn system_dir(arguments: &RunArguments, system: &System) -> Result<SystemDir, Problem> {
    let own = arguments.runtime_dir.as_ref().map(|folder| folder.clone().into_os_string());
    let variable = |name: &str| match (name, &own) {
        ("SCL_RUNTIME_DIR", Some(folder)) => Some(folder.clone()),
        _ => std::env::var_os(name),
    };
    let name = std::env::var("SCL_SYSTEM").ok().filter(|name| !name.is_empty());
    let name = name.unwrap_or_else(|| system.plan.system.clone());
    let dir = RuntimeDir::locate(&variable).and_then(|dir| dir.system(&name));
    dir.map_err(|error| Problem::new(text_with_causes(&error)))
}

/// Returns the transport on which the ends of mirrored components listen. The choices for single gates and for shared
/// memory do not apply to connections to other hosts.
fn transport_kind() -> Result<TransportKind, Problem> {
    let value = std::env::var_os("SCL_TRANSPORT").unwrap_or_default();
    let choice = match &*value.to_string_lossy() {
        "" => TransportChoice::default(),
        text => text.parse().map_err(|error| Problem::new(format!("`SCL_TRANSPORT` is not understood: {error}")))?,
    };
    match choice.default_kind() {
        TransportKind::Tcp => Ok(TransportKind::Tcp),
        _ => Ok(TransportKind::Ipc),
    }
}

fn shown<T>(result: Result<T, Problem>) -> Option<T> {
    result.map_err(|problem| show(&problem)).ok()
}
