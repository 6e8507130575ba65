//! `scl bench`: SCL beside raw sockets and other libraries, on this machine.

mod limits;

use clap::{Args, Subcommand, ValueEnum};
use limits::{MESSAGES, REPETITIONS, parse_seconds, within};
use scl_bench::{
    CodecsOptions, Cores, DelayOptions, FanoutOptions, FreshOptions, GatewayGrowthOptions, RateOptions, Report,
    RestartOptions, RoundtripOptions, Transport,
};
use scl_terminal::{print_err, print_out};
use std::process::ExitCode;
use std::time::Duration;

/// The hidden command with which a benchmark starts its worker processes.
pub(crate) const WORKER_COMMAND: &str = scl_bench::WORKER_COMMAND;

/// Measure SCL on this machine, beside raw sockets and other libraries.
///
/// Every benchmark runs SCL and its baselines in turn within one run, so that other load on the machine affects all of
/// them alike. Times and rates depend on the machine; the ratios hold.
#[derive(Args)]
#[command(after_help = READING, after_long_help = format!("{READING}\n\n{EXAMPLES}"))]
pub(crate) struct BenchArguments {
    #[command(subcommand)]
    benchmark: Benchmark,
    /// Print one JSON object instead of tables.
    #[arg(long, global = true)]
    json: bool,
    /// Print the distribution of the durations below each table.
    #[arg(long, global = true, conflicts_with = "json")]
    histogram: bool,
    /// Where the processes run: placed by the operating system, all on one core, or the two sides on a core each.
    /// Placement matters more than the library, so compare only runs on `one` or `two`.
    #[arg(long, global = true, value_enum, default_value_t)]
    cores: CoresArgument,
    /// Measure next to nothing, to test that everything runs.
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

#[derive(Clone, Copy, Default, ValueEnum)]
enum TransportArgument {
    /// Unix sockets, beside other libraries over Unix sockets.
    #[default]
    Ipc,
    /// Shared memory, beside plain iceoryx2; takes the feature `shm` of this program.
    Shm,
    /// Two gateways on loopback, beside plain zenoh; takes the feature `gateway` of this program.
    Gateway,
}

impl From<TransportArgument> for Transport {
    fn from(argument: TransportArgument) -> Self {
        match argument {
            TransportArgument::Ipc => Self::Ipc,
            TransportArgument::Shm => Self::Shm,
            TransportArgument::Gateway => Self::Gateway,
        }
    }
}

/// The message sizes to measure: those given, or the defaults of a transport.
fn sizes(given: &[usize], transport: TransportArgument) -> Vec<usize> {
    match (given, transport) {
        ([], TransportArgument::Shm) => vec![1 << 10, 64 << 10, 4 << 20],
        ([], _) => vec![20, 1 << 10, 64 << 10],
        (given, _) => given.to_vec(),
    }
}

const READING: &str = "A line `SCL pub/sub to libzmq XPUB/SUB` has the first one's value divided by the second one's: \
1.10 is 10 % more, 0.50 is half. Quartiles tell how much the ratio varies during the run. `docs/bench.md` explains \
every table.";

const EXAMPLES: &str = "Examples:
  scl bench roundtrip --bytes 20 --cores one
  scl bench rate --cores two --json > rate.json
  sudo scl bench delay --seconds 60 --histogram";

#[derive(Subcommand)]
enum Benchmark {
    /// Measure the time of a message to another process and back: pub/sub and req/rep, async and blocking.
    ///
    /// Baselines: Unix sockets (tokio and blocking), the same patterns of `zeromq`, and of libzmq if this program was
    /// built with its feature `libzmq`.
    Roundtrip {
        /// The message sizes in bytes, one table each. Default: 20,1024,65536; over shared memory 1024,65536,4194304.
        #[arg(long, value_delimiter = ',', value_parser = within(RoundtripOptions::BYTES))]
        bytes: Vec<usize>,
        /// The number of round trips for each size and line; at most 4 GiB are sent.
        #[arg(long, default_value_t = 20_000, value_parser = within(MESSAGES))]
        messages: usize,
        /// What is under the connections of SCL, which decides what they are compared with.
        #[arg(long, value_enum, default_value_t)]
        transport: TransportArgument,
    },
    /// Measure messages per second from one process to another, none lost: pub/sub and push/pull, async and blocking.
    ///
    /// Baselines: the same patterns of `zeromq`, a Unix socket, and of libzmq, with bounded and unbounded queues, if
    /// this program was built with its feature `libzmq`.
    Rate {
        /// The message sizes in bytes, one table each. Default: 20,1024,65536; over shared memory 1024,65536,4194304.
        #[arg(long, value_delimiter = ',', value_parser = within(RateOptions::BYTES))]
        bytes: Vec<usize>,
        /// The number of messages for each size and line; at most 4 GiB are sent.
        #[arg(long, default_value_t = 500_000, value_parser = within(MESSAGES))]
        messages: usize,
        /// What is under the connections of SCL, which decides what they are compared with.
        #[arg(long, value_enum, default_value_t)]
        transport: TransportArgument,
    },
    /// Measure the age of the first value that a subscriber with `queue: 1` receives after a pause.
    ///
    /// Baselines: a SUB socket of `zeromq`, and one of libzmq with ZMQ_CONFLATE if this program was built with its
    /// feature `libzmq`.
    Fresh {
        /// How often each subscriber pauses.
        #[arg(long, default_value_t = 10, value_parser = within(REPETITIONS))]
        repetitions: usize,
        /// How long a subscriber does not receive.
        #[arg(long, default_value_t = 2.0, value_parser = parse_seconds)]
        pause: f64,
    },
    /// Measure the time until messages flow again after one side was killed and restarted, for all six roles.
    ///
    /// Baselines: a process that connects to a Unix socket, `zeromq`, and libzmq if this program was built with its
    /// feature `libzmq`.
    Restart {
        /// How often each side is restarted.
        #[arg(long, default_value_t = 30, value_parser = within(REPETITIONS))]
        restarts: usize,
    },
    /// Measure the delay of 20 bytes at 1000 Hz: idle, under load, and with real-time priority if permitted.
    ///
    /// The load is one thread per core that computes, and one that writes to the disk. Real-time priority is set by
    /// `chrt -f 80`, which needs root or the limit `rtprio`. Baselines: `zeromq` and a Unix socket.
    Delay {
        /// How long each line is measured.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// Measure the delay from one publisher to eight subscribers at 1000 Hz, while all run and while one is stopped.
    ///
    /// Measured at the other seven. Baseline: a PUB socket of `zeromq` for all eight.
    Fanout {
        /// How long each line is measured.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// Measure the time to encode and decode a record, and its size, for every codec.
    ///
    /// Baselines: the libraries `prost` and `serde_json` without SCL.
    Codecs {
        /// The number of records that each codec encodes and decodes.
        #[arg(long, default_value_t = 100_000, value_parser = within(MESSAGES))]
        messages: usize,
    },
    /// Measure how the cost of a gateway grows with its connections: time until all are matched, memory, processor
    /// time, round trip.
    ///
    /// Needs the program `scl-gateway` beside this one or in `PATH`, and the feature `gateway` of this program.
    GatewayGrowth {
        /// The numbers of connections, one line each.
        #[arg(
            long,
            value_delimiter = ',',
            default_values_t = [1, 10, 50, 100, 200, 500],
            value_parser = within(GatewayGrowthOptions::CONNECTIONS)
        )]
        connections: Vec<usize>,
        /// The number of other hosts, each with a gateway, between which the connections are divided.
        #[arg(long, default_value_t = 1, value_parser = within(GatewayGrowthOptions::HOSTS))]
        hosts: usize,
        /// How long each line is observed while idle, and as long under load.
        #[arg(long, default_value_t = 10.0, value_parser = parse_seconds)]
        seconds: f64,
        /// The number of round trips of each line.
        #[arg(long, default_value_t = 1000, value_parser = within(MESSAGES))]
        messages: usize,
    },
}

/// The arguments of a worker process.
#[derive(Args)]
pub(crate) struct WorkerArguments {
    #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<String>,
}

pub(crate) fn bench(arguments: &BenchArguments) -> ExitCode {
    let cores = Cores::from(arguments.cores);
    match cores.pin().and_then(|()| measure(&arguments.benchmark, arguments.quick)) {
        Ok(report) => {
            let report = report.with_cores(cores);
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

pub(crate) fn run_worker(arguments: &WorkerArguments) -> ExitCode {
    match scl_bench::run_worker(&arguments.arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failed(&error),
    }
}

fn measure(benchmark: &Benchmark, quick: bool) -> scl_bench::Result<Report> {
    let few = |number: usize, max: usize| if quick { number.min(max) } else { number };
    let short = |seconds: f64| Duration::from_secs_f64(if quick { seconds.min(0.05) } else { seconds });
    match benchmark {
        Benchmark::Roundtrip { bytes, messages, transport } => scl_bench::measure_roundtrip(&RoundtripOptions {
            bytes: sizes(bytes, *transport),
            messages: few(*messages, 50),
            transport: (*transport).into(),
        }),
        Benchmark::Rate { bytes, messages, transport } => scl_bench::measure_rate(&RateOptions {
            bytes: sizes(bytes, *transport),
            messages: few(*messages, 50),
            transport: (*transport).into(),
        }),
        Benchmark::Fresh { repetitions, pause } => {
            scl_bench::measure_fresh(&FreshOptions { repetitions: few(*repetitions, 2), pause: short(*pause) })
        }
        Benchmark::Restart { restarts } => scl_bench::measure_restart(&RestartOptions { restarts: few(*restarts, 1) }),
        Benchmark::Delay { seconds } => scl_bench::measure_delay(&DelayOptions { time: short(*seconds) }),
        Benchmark::Fanout { seconds } => scl_bench::measure_fanout(&FanoutOptions { time: short(*seconds) }),
        Benchmark::Codecs { messages } => scl_bench::measure_codecs(&CodecsOptions { messages: few(*messages, 50) }),
        Benchmark::GatewayGrowth { connections, hosts, seconds, messages } => {
            scl_bench::measure_gateway_growth(&GatewayGrowthOptions {
                connections: connections.iter().map(|&connections| few(connections, 3)).collect(),
                hosts: *hosts,
                time: short(*seconds),
                messages: few(*messages, 50),
            })
        }
    }
}

fn failed(error: &scl_bench::Error) -> ExitCode {
    print_err(&format!("error: {error:?}\n"));
    ExitCode::from(2)
}
