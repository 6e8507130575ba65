//! `scl foxglove`: the messages of a running system, or of a recording, for Foxglove and Lichtblick.
//!
//! The server speaks the protocol `foxglove.sdk.v1`. Gates are topics, as in recordings; `rep` gates are services and
//! live parameters are parameters, if the user allows acting.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod channels;
mod companions;
mod graph;
mod listen;
mod live;
mod parameters;
mod playback;
mod publishing;
mod services;
mod source;
mod template;

use clap::Parser;
use companions::Descriptions;
use listen::Listen;
use live::Live;
use playback::Playback;
use scl_observe::{Commands, StopSignals, System, block_on};
use scl_record::recording::{Recording, find_files};
use scl_terminal::{Problem, print_err, print_out};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;
use std::process::ExitCode;

/// Show a running system, or a recording, in Foxglove or Lichtblick.
///
/// Open the printed address there, as a connection of the kind "Foxglove WebSocket". Gates are topics, as in
/// recordings: `/sensor/measurements`. Messages of protobuf and JSON come as they are, those of CBOR and MessagePack as
/// JSON. Only what a panel shows is observed, and components notice nothing. With `--control`, `rep` gates are
/// services, and panels set live parameters and publish at gates of components that do not run.
#[derive(Parser)]
#[command(name = "scl foxglove", version)]
#[command(after_help = "\
Examples:
  scl foxglove                          the system that runs
  scl foxglove --control                panels may also call gates, publish, and set live parameters
  scl foxglove --topics panels.yaml     also topics for maps and 3D, made of messages
  scl foxglove --replay flight.mcap     a recording, which Foxglove plays

Exit code: 0 stopped with Ctrl-C, 2 no such system or recording, or the port is in use.")]
struct Arguments {
    /// The system [default: $SCL_SYSTEM, or the only one that runs, or that of ./topology.yaml].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    /// The address to listen at; 0.0.0.0 for other machines. Messages are not encrypted.
    #[arg(long, value_name = "IP", default_value = "127.0.0.1")]
    listen: IpAddr,
    /// The port; 0 for any that is free.
    #[arg(long, value_name = "PORT", default_value_t = 8765)]
    port: u16,
    /// Let panels call `rep` gates, publish in place of components that do not run, and set live parameters.
    #[arg(long)]
    control: bool,
    /// Also send topics that this file describes, made of messages, for panels that show maps and 3D.
    #[arg(long, value_name = "FILE")]
    topics: Option<PathBuf>,
    /// Show a recording instead.
    #[arg(long, value_name = "FILE", num_args = 1.., conflicts_with_all = ["system", "control"])]
    replay: Vec<PathBuf>,
}

fn main() -> ExitCode {
    match block_on(run(&Arguments::parse())) {
        Ok(()) => ExitCode::SUCCESS,
        Err(problem) => {
            print_err(&problem.to_string());
            ExitCode::from(2)
        }
    }
}

async fn run(arguments: &Arguments) -> Result<(), Problem> {
    let mut stop = StopSignals::watch()?;
    let descriptions = arguments.topics.as_deref().map(Descriptions::read).transpose()?.unwrap_or_default();
    let listen = Listen::new(SocketAddr::new(arguments.listen, arguments.port));
    let started = |port| print_out(&format!("ws://{}\n", SocketAddr::new(arguments.listen, port)));
    if arguments.replay.is_empty() {
        let system = System::find_or_await(arguments.system.as_deref())?;
        let commands = arguments.control.then(|| Commands::new(scl(), system.name()));
        let live = Live::start(listen, system, commands, descriptions).await?;
        started(live.port());
        tokio::select! {
            () = live.run() => {}
            () = stop.received() => {}
        }
    } else {
        let recording = Recording::open(&find_files(&arguments.replay)?)?;
        let playback = Playback::start(&listen, &recording, &descriptions).await?;
        started(playback.port());
        tokio::select! {
            played = playback.run() => played?,
            () = stop.received() => {}
        }
    }
    Ok(())
}

/// The program `scl`, which acts for panels.
fn scl() -> PathBuf {
    // `scl foxglove` names itself; otherwise it lies beside this program.
    let beside = || std::env::current_exe().ok().map(|own| own.with_file_name("scl")).filter(|scl| scl.is_file());
    std::env::var_os("SCL").map(PathBuf::from).or_else(beside).unwrap_or_else(|| "scl".into())
}
