//! `scl replay`: plays recorded components in a running system.

use crate::exit::COULD_NOT_DO;
use crate::format::FormatArgument;
use crate::load::{MaxSize, load_file, show_errors};
use clap::Args;
use scl_record::progress::Progress;
use scl_record::recording::{Recording, find_files};
use scl_record::replay::{Rate, ReplayOptions, replay as play};
use scl_terminal::{Problem, parse_duration, print_err};
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Duration;

/// Play recorded components in a running system.
///
/// Sends what the played components have sent, with the recorded timing; their `rep` gates answer as recorded.
/// Peers cannot tell them from the real programs. Without `--as`, plays all recorded components that are not running.
///
/// What a gate receives is recorded without its sender, so a component that is one of several pushers or requesters of
/// a gate is replayed only together with the others.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl replay flight.mcap --as sensor           the recorded sensor, for the programs that run
  scl replay flight.mcap --as sensor,gps --rate 2
  scl replay flight.mcap --rate max            as fast as the peers take it; nothing is dropped
  scl replay flight.mcap --start 10s --end 40s --loop
  scl replay flight_*.mcap                     all parts of a split recording

Did yesterday's flight change the controller's outputs? In CI, while the new controller runs:
  scl record controller.actuator -o new.mcap &
  scl replay flight.mcap --as sensor,user_interface
  kill -INT %1; wait
  scl compare flight.mcap new.mcap --gate controller.actuator --within 1e-6

Exit code: 0 replayed or stopped, 1 with `--rate max` a peer has not taken everything, 2 could not replay.")]
pub(crate) struct ReplayArguments {
    /// The recording, or all of its parts; `flight.mcap` also finds the parts `flight_1.mcap`, ...
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Play these components.
    #[arg(long = "as", value_name = "COMPONENT,...", value_delimiter = ',')]
    components: Vec<String>,
    /// How many times as fast, for example 0.5 or 2; `max`: as fast as the peers take it.
    #[arg(long, value_name = "FACTOR|max", default_value = "1", value_parser = parse_rate)]
    rate: Rate,
    /// Begin at this time of the recording.
    #[arg(long, value_name = "TIME", default_value = "0s", value_parser = parse_duration)]
    start: Duration,
    /// End at this time of the recording.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    end: Option<Duration>,
    /// Shorten pauses between messages to this time of the recording, for example where its clock was set forward.
    #[arg(long, value_name = "TIME", value_parser = parse_duration)]
    max_gap: Option<Duration>,
    /// Begin again at the end, until Ctrl-C.
    #[arg(long = "loop")]
    repeat: bool,
    /// Replay these gates only.
    #[arg(long, value_name = "GATE,...", value_delimiter = ',')]
    only: Vec<String>,
    /// The name of the system [default: $SCL_SYSTEM, else the recorded one].
    #[arg(long, value_name = "NAME")]
    system: Option<String>,
    /// How long to wait for the peers of the played components; `0s`: do not wait.
    #[arg(long, value_name = "TIME", default_value = "10s", value_parser = parse_duration)]
    ready: Duration,
    /// Play the components as declared in this topology file, not as recorded.
    #[arg(long, value_name = "FILE")]
    topology: Option<PathBuf>,
    #[command(flatten)]
    format: FormatArgument,
}

/// The body of `scl replay`.
pub(crate) fn replay(arguments: &ReplayArguments) -> Result<ExitCode, Problem> {
    let plan = match &arguments.topology {
        None => None,
        Some(file) => {
            let loaded = load_file(file, MaxSize::default());
            let Some(plan) = loaded.system_plan() else {
                show_errors(&loaded);
                return Ok(ExitCode::from(COULD_NOT_DO));
            };
            Some(plan)
        }
    };
    let options = ReplayOptions {
        components: arguments.components.clone(),
        only: arguments.only.clone(),
        rate: arguments.rate,
        start: arguments.start,
        end: arguments.end,
        repeat: arguments.repeat,
        system: arguments.system.clone(),
        max_gap: arguments.max_gap,
        ready_within: arguments.ready,
        plan,
    };
    let recording = Recording::open(&find_files(&arguments.files)?)?;
    // `scl run` or systemd may have started this process in place of the component's own program.
    scl::host::notify_service_manager();
    let survey = recording.survey()?;
    // If there are no messages, `play` fails, and its error contains the notes.
    let notes = recording.notes().into_iter().chain(survey.first_ns.map(|_| survey.notes()).into_iter().flatten());
    notes.for_each(|note| print_err(&format!("note: {note}\n")));
    if !survey.gaps.is_empty() && options.max_gap.is_none() && options.rate != Rate::Max {
        print_err("help: `--max-gap 1s` shortens pauses between messages\n");
    }
    let progress = Progress::new("replaying", survey.length);
    let report = scl_observe::block_on(play(&recording, &survey, &options, &|position| progress.set(position)))?;
    drop(progress);
    arguments.format.print(|| report.to_json(), || report.to_text());
    let is_incomplete = options.rate == Rate::Max && !report.was_stopped && report.is_incomplete();
    Ok(if is_incomplete { ExitCode::FAILURE } else { ExitCode::SUCCESS })
}

fn parse_rate(text: &str) -> Result<Rate, String> {
    if text == "max" {
        return Ok(Rate::Max);
    }
    let factor: Option<f64> = text.strip_suffix('x').unwrap_or(text).parse().ok();
    let factor = factor.filter(|factor| factor.is_finite() && *factor > 0.0);
    factor.map(Rate::Times).ok_or_else(|| "expected a factor above 0, like `0.5` or `2`, or `max`".to_owned())
}
