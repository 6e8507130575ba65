//! `scl bench`: SCL beside its raw parts on this machine.

mod limits;

use crate::print::{print_err, print_out};
use clap::{Args, Subcommand, ValueEnum};
use limits::{MESSAGES, STARTS, parse_seconds, within};
use scl_bench::{Codecs, Cores, Delay, Fanout, Open, Rate, Report, Roundtrip};
use std::process::ExitCode;
use std::time::Duration;

/// The hidden word with which a scenario starts its other processes.
pub(crate) const OTHER_SIDE_WORD: &str = scl_bench::OTHER_SIDE;

/// Measure SCL on this machine, beside the raw sockets and libraries that it is made of.
///
/// Every scenario runs SCL and its raw parts in turn within one run, so that whatever else the machine does falls on
/// all of them alike. Times and rates depend on the machine; the ratios to the raw parts hold.
#[derive(Args)]
#[command(after_help = READING, after_long_help = format!("{READING}\n\n{EXAMPLES}"))]
pub(crate) struct BenchArguments {
    #[command(subcommand)]
    scenario: Scenario,
    /// Print one JSON object instead of tables.
    #[arg(long, global = true)]
    json: bool,
    /// Print below each table how its times are distributed: the last percents, and a line of where they all lie.
    #[arg(long, global = true, conflicts_with = "json")]
    histogram: bool,
    /// Where the processes run: on whatever core the operating system likes, all on one, or the two sides on one each.
    /// Where two processes were put decides more than any library between them, so ratios are exact only on `one` or
    /// `two`.
    #[arg(long, global = true, value_enum, default_value_t)]
    cores: CoresArgument,
    /// Measure next to nothing: enough to see that everything runs.
    #[arg(long, global = true, hide = true)]
    quick: bool,
}

#[derive(Clone, Copy, Default, ValueEnum)]
enum CoresArgument {
    #[default]
    Any,
    One,
    Two,
}

impl From<CoresArgument> for Cores {
    fn from(argument: CoresArgument) -> Self {
        match argument {
            CoresArgument::Any => Self::Any,
            CoresArgument::One => Self::One,
            CoresArgument::Two => Self::Two,
        }
    }
}

const READING: &str = "`p50 us ratio to zeromq` is this row's median by that of the raw `zeromq` sockets: 1.10 is 10 % \
slower, 0.50 takes half the time. Of a rate, more is better. `docs/bench.md` explains every table.";

const EXAMPLES: &str = "Examples:
  scl bench roundtrip --bytes 20 --histogram
  scl bench rate --json > rate.json
  sudo scl bench delay --seconds 60";

#[derive(Subcommand)]
enum Scenario {
    /// The time of a message to another process and back, by publishing and by asking, async and blocking.
    ///
    /// Beside it: sockets of `zeromq` of the same kinds, plain Unix sockets, and libzmq where this program was built
    /// with its feature `libzmq`.
    Roundtrip {
        /// The lengths of the messages, in bytes; a table each.
        #[arg(long, value_delimiter = ',', default_values_t = [20, 1024, 65536], value_parser = within(Roundtrip::BYTES))]
        bytes: Vec<usize>,
        /// How many messages of each length go each way.
        #[arg(long, default_value_t = 20_000, value_parser = within(MESSAGES))]
        messages: usize,
    },
    /// Messages a second from one process to another, none lost, published and pushed.
    ///
    /// Beside it: sockets of `zeromq` of the same kinds, a Unix socket, and libzmq where this program was built with
    /// its feature `libzmq`.
    Rate {
        /// The lengths of the messages, in bytes; a table each.
        #[arg(long, value_delimiter = ',', default_values_t = [20, 1024], value_parser = within(Rate::BYTES))]
        bytes: Vec<usize>,
        /// How many messages of each length go each way.
        #[arg(long, default_value_t = 500_000, value_parser = within(MESSAGES))]
        messages: usize,
    },
    /// The delay of 20 bytes at 1000 Hz: idle, under load, and with real-time priority where that is permitted.
    ///
    /// The load is made by this program: a thread a core that computes, and one that writes to the disk. Real-time
    /// priority is taken with `chrt -f 80`, which needs root or the limit `rtprio`. Beside it: `zeromq` and a Unix
    /// socket.
    Delay {
        /// How long each way is measured in each situation.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// The delay from one process to eight at 1000 Hz, while all of them run and while one of them is stopped.
    ///
    /// Measured at the other seven. Beside it: one PUB socket of `zeromq` that all eight share.
    Fanout {
        /// How long each way is measured in each situation.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// The time to encode and decode a record, and its length, for every codec.
    ///
    /// Beside it: the libraries `prost` and `serde_json` without SCL, and XML, which SCL does not offer.
    Codecs {
        /// How many records each codec encodes and decodes.
        #[arg(long, default_value_t = 100_000, value_parser = within(MESSAGES))]
        messages: usize,
    },
    /// The time to open a component of ten gates, its memory, and how often it wakes up when idle.
    ///
    /// Beside it: ten sockets of `zeromq`, and a process with nothing but the async runtime.
    Open {
        /// How often it is started.
        #[arg(long, default_value_t = 30, value_parser = within(STARTS))]
        starts: usize,
    },
}

/// What the other processes of a scenario are told.
#[derive(Args)]
pub(crate) struct OtherSideArguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    words: Vec<String>,
}

pub(crate) fn bench(arguments: &BenchArguments) -> ExitCode {
    let cores = Cores::from(arguments.cores);
    match cores.occupy().and_then(|()| measure(&arguments.scenario, arguments.quick)) {
        Ok(report) => {
            let report = report.on(cores);
            print_out(&match (arguments.json, arguments.histogram) {
                (true, _) => format!("{:#}\n", report.to_json()),
                (false, true) => format!("{report:#}"),
                (false, false) => report.to_string(),
            });
            ExitCode::SUCCESS
        }
        Err(error) => failed(&error),
    }
}

pub(crate) fn play_other_side(arguments: &OtherSideArguments) -> ExitCode {
    match scl_bench::play_other_side(&arguments.words) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&error),
    }
}

fn measure(scenario: &Scenario, quick: bool) -> scl_bench::Result<Report> {
    let few = |messages: usize| if quick { messages.min(50) } else { messages };
    let short = |seconds: f64| Duration::from_secs_f64(if quick { seconds.min(0.05) } else { seconds });
    match scenario {
        Scenario::Roundtrip { bytes, messages } => scl_bench::measure_roundtrip(&Roundtrip {
            bytes: bytes.clone(),
            messages: few(*messages),
            allocations: None,
        }),
        Scenario::Rate { bytes, messages } => {
            scl_bench::measure_rate(&Rate { bytes: bytes.clone(), messages: few(*messages), allocations: None })
        }
        Scenario::Delay { seconds } => scl_bench::measure_delay(&Delay { time: short(*seconds) }),
        Scenario::Fanout { seconds } => scl_bench::measure_fanout(&Fanout { time: short(*seconds) }),
        Scenario::Codecs { messages } => scl_bench::measure_codecs(&Codecs { messages: few(*messages) }),
        Scenario::Open { starts } => {
            let idle = Duration::from_millis(if quick { 50 } else { 1000 });
            scl_bench::measure_open(&Open { starts: if quick { 1 } else { *starts }, idle })
        }
    }
}

fn failed(error: &scl_bench::Error) -> ExitCode {
    print_err(&format!("error: {error:?}\n"));
    ExitCode::from(2)
}
