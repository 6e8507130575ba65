//! `scl record`: records what passes the gates of a running system into MCAP files.

use crate::format::FormatArgument;
use crate::load::{MaxSize, parse_size, request};
use crate::observed::SystemArgument;
use clap::Args;
use scl_observe::System;
use scl_record::format::{LAUNCH, TOPOLOGY};
use scl_record::record::{self, AttachedFile, Options, RingOptions, Split};
use scl_terminal::{Problem, escape, parse_duration, print_err, print_out};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

/// Record messages, requests and replies of a running system into an MCAP file.
///
/// The gates are observed at their taps; a recorder that cannot keep up never slows them down. Components that start
/// later or start again are recorded too; a system that is named with `--system` may itself start later. Ctrl-C or
/// SIGTERM ends the recording. The final report and the file say how many messages of each gate were recorded and
/// lost.
///
/// Everything is handed to the operating system each second, so that a crash of the recorder loses at most that second.
/// `scl recover` rebuilds the index of such a file.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl record                                         all gates, until Ctrl-C
  scl record sensor controller.commands -o flight.mcap
  scl record --exclude camera.image --for 60s
  scl record --split 1GiB --split 10min --keep 20    flight_0001.mcap, flight_0002.mcap, ...
  scl record --ring 30s -o crash.mcap                in memory, until `scl record --trigger`

Exit code: 0 recorded, 1 nothing was recorded or it ended early (a full disk), 2 no such gate, system or file.")]
pub(crate) struct RecordArguments {
    /// Gates (`sensor.measurements`) or all gates of components (`sensor`) [default: all].
    gates: Vec<String>,
    /// Record all gates, which is the default.
    #[arg(long, conflicts_with = "gates")]
    all: bool,
    /// Leave out a gate or component; may be repeated.
    #[arg(long, value_name = "GATE")]
    exclude: Vec<String>,
    /// The file, or a folder [default: <system>_<time>.mcap].
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Replace existing files.
    #[arg(long)]
    overwrite: bool,
    /// Stop after this time, for example `60s`.
    #[arg(long = "for", value_name = "TIME", value_parser = parse_duration)]
    run_for: Option<Duration>,
    /// Begin a new file at this size or after this time: `1GiB`, `10min`, or both.
    #[arg(long, value_name = "SIZE|TIME", value_parser = parse_limit, conflicts_with = "ring")]
    split: Vec<Limit>,
    /// Keep this many files of a split recording, and delete older ones that it wrote.
    #[arg(long, value_name = "N", requires = "split", value_parser = clap::value_parser!(u32).range(1..))]
    keep: Option<u32>,
    /// Force everything to the disk this often, against loss of power.
    #[arg(long, value_name = "TIME", value_parser = parse_duration, conflicts_with = "ring")]
    sync: Option<Duration>,
    /// Keep only messages that are at most this old, in memory, and write them on SIGUSR1 or `--trigger`.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    ring: Option<Duration>,
    /// Write the ring also when the recorder ends.
    #[arg(long, requires = "ring")]
    save_at_exit: bool,
    /// Make the running recorders with a ring write it, and print the files.
    #[arg(long, conflicts_with_all = ["gates", "ring", "split", "output", "run_for"])]
    trigger: bool,
    /// Memory for messages that wait for the disk; a ring may use the same amount again.
    #[arg(long, value_name = "SIZE", value_parser = parse_size, default_value = "256MiB")]
    memory: u64,
    /// The topology file to add to the recording [default: ./topology.yaml, if it describes this system].
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    /// The launch file to add to the recording [default: ./launch.yaml beside that topology file].
    #[arg(long, value_name = "FILE")]
    launch: Option<PathBuf>,
    #[command(flatten)]
    system: SystemArgument,
    #[command(flatten)]
    format: FormatArgument,
}

/// One value of `--split`.
#[derive(Debug, Clone, Copy)]
enum Limit {
    Bytes(u64),
    Time(Duration),
}

fn parse_limit(text: &str) -> Result<Limit, String> {
    match (parse_duration(text), parse_size(text)) {
        (Ok(time), _) if !time.is_zero() => Ok(Limit::Time(time)),
        (_, Ok(bytes)) if bytes > 0 => Ok(Limit::Bytes(bytes)),
        _ => Err("expected a size such as `1GiB` or a time such as `10min`".to_owned()),
    }
}

/// The body of `scl record`.
pub(crate) fn record(arguments: &RecordArguments) -> Result<ExitCode, Problem> {
    if arguments.trigger {
        let system = System::find(arguments.system.name())?;
        for file in record::trigger(&system)? {
            print_out(&format!("{}\n", escape(&file.to_string_lossy())));
        }
        return Ok(ExitCode::SUCCESS);
    }
    let system = System::find_or_await(arguments.system.name())?;
    let report = record::record(&system, &options(arguments, &system)?)?;
    arguments.format.print(|| report.json(), || report.text());
    if let Some(problem) = &report.problem {
        print_err(&problem.to_string());
        return Ok(ExitCode::FAILURE);
    }
    if report.recorded() == 0 {
        print_err("no message was seen\n");
        return Ok(ExitCode::FAILURE);
    }
    Ok(ExitCode::SUCCESS)
}

fn options(arguments: &RecordArguments, system: &System) -> Result<Options, Problem> {
    let mut split = Split { keep: arguments.keep.map(|keep| keep as usize), ..Split::default() };
    for limit in &arguments.split {
        match limit {
            Limit::Bytes(bytes) => split.bytes = Some(*bytes),
            Limit::Time(time) => split.time = Some(*time),
        }
    }
    Ok(Options {
        gates: arguments.gates.clone(),
        exclude: arguments.exclude.clone(),
        output: arguments.output.clone(),
        overwrite: arguments.overwrite,
        run_for: arguments.run_for,
        split,
        sync: arguments.sync,
        memory: usize::try_from(arguments.memory).unwrap_or(usize::MAX),
        ring: arguments.ring.map(|window| RingOptions { window, save_at_end: arguments.save_at_exit }),
        topology: arguments.topology.clone().unwrap_or_else(|| TOPOLOGY.into()),
        attached: attached_files(arguments, system)?,
    })
}

/// Reads the topology and launch file to attach: those that the user names, else those in the working folder if its
/// topology describes this system.
fn attached_files(arguments: &RecordArguments, system: &System) -> Result<Vec<AttachedFile>, Problem> {
    let is_ours = describes(Path::new(TOPOLOGY), system);
    let chosen = [(TOPOLOGY, &arguments.topology), (LAUNCH, &arguments.launch)];
    let mut attached = Vec::new();
    for (name, path) in chosen {
        match path {
            Some(path) => {
                let data = fs::read(path)
                    .map_err(|error| Problem::new(format!("cannot read `{}`: {error}", path.display())))?;
                attached.push(AttachedFile { name, data });
            }
            // The launch file is optional.
            None if is_ours => attached.extend(fs::read(name).ok().map(|data| AttachedFile { name, data })),
            None => {}
        }
    }
    Ok(attached)
}

fn describes(topology: &Path, system: &System) -> bool {
    let loaded = topology.is_file().then(|| scl_loader::load(&request(topology, MaxSize::default())));
    let name = loaded.and_then(|loaded| Some(loaded.topology?.system().to_owned()));
    name.is_some_and(|name| name == system.name())
}
