//! The arguments of `scl bench`, and what they select.

use crate::cores::Cores;
use crate::gateway_growth::{GatewayGrowthOptions, measure_gateway_growth};
use crate::limits::{MESSAGES, REPETITIONS, parse_seconds, within};
use crate::report::Report;
use crate::transport::Transport;
use crate::{codecs, delay, fanout, fresh, rate, restart, roundtrip};
use clap::{Args, Subcommand};
use std::time::Duration;

/// Measure SCL on this machine, beside raw sockets and other libraries.
///
/// Every benchmark runs SCL and its baselines in turn within one run, so that other load on the machine affects all of
/// them alike. Times and rates depend on the machine; the ratios hold.
#[derive(Debug, Args)]
#[command(after_help = READING, after_long_help = format!("{READING}\n\n{EXAMPLES}"))]
pub struct BenchArguments {
    #[command(subcommand)]
    benchmark: Benchmark,
    /// Print one JSON object instead of tables.
    #[arg(long, global = true)]
    json: bool,
    /// Print the distribution of the durations below each table.
    #[arg(long, global = true, conflicts_with = "json")]
    histogram: bool,
    /// Where the processes run: placed by the operating system, all on one core, or each side on its own core.
    /// Placement matters more than the library, so compare only runs on `one` or `two`.
    #[arg(long, global = true, value_enum, default_value_t)]
    cores: Cores,
    /// Measure only briefly, to test that everything runs.
    #[arg(long, global = true, hide = true)]
    quick: bool,
}

const READING: &str = "A line `SCL pub/sub to libzmq XPUB/SUB` shows the first value divided by the second: 1.10 is \
10 % more, 0.50 is half. Quartiles show how much the ratio varies during the run. `docs/bench.md` explains every \
table.";

const EXAMPLES: &str = "Examples:
  scl bench roundtrip --bytes 20 --cores one
  scl bench rate --cores two --json > rate.json
  sudo scl bench delay --seconds 60 --histogram";

/// A benchmark and its options.
#[derive(Debug, Subcommand)]
enum Benchmark {
    /// Measure the time of a message to another process and back: pub/sub and req/rep, async and blocking.
    ///
    /// Baselines: Unix sockets (tokio and blocking), the same patterns of `zeromq`, and of libzmq if this program was
    /// built with its feature `libzmq`.
    Roundtrip {
        /// The message sizes in bytes, one table each. Default: 20,1024,65536; over shared memory 1024,65536,4194304.
        #[arg(long, value_delimiter = ',', value_parser = within(roundtrip::BYTES))]
        bytes: Vec<usize>,
        /// The number of round trips for each size and line; at most 4 GiB are sent.
        #[arg(long, default_value_t = 20_000, value_parser = within(MESSAGES))]
        messages: usize,
        /// The transport of the `SCL` lines, which also determines what they are compared with.
        #[arg(long, value_enum, default_value_t)]
        transport: Transport,
    },
    /// Measure messages per second from one process to another, none lost: pub/sub and push/pull, async and blocking.
    ///
    /// Baselines: the same patterns of `zeromq`, a Unix socket, and of libzmq, with bounded and unbounded queues, if
    /// this program was built with its feature `libzmq`.
    Rate {
        /// The message sizes in bytes, one table each. Default: 20,1024,65536; over shared memory 1024,65536,4194304.
        #[arg(long, value_delimiter = ',', value_parser = within(rate::BYTES))]
        bytes: Vec<usize>,
        /// The number of messages for each size and line; at most 4 GiB are sent.
        #[arg(long, default_value_t = 500_000, value_parser = within(MESSAGES))]
        messages: usize,
        /// The transport of the `SCL` lines, which also determines what they are compared with.
        #[arg(long, value_enum, default_value_t)]
        transport: Transport,
    },
    /// Measure the age of the first value that a subscriber with `queue: 1` receives after a pause.
    ///
    /// Baselines: a SUB socket of `zeromq`, and one of libzmq with ZMQ_CONFLATE if this program was built with its
    /// feature `libzmq`.
    Fresh {
        /// How often each subscriber pauses.
        #[arg(long, default_value_t = 10, value_parser = within(REPETITIONS))]
        repetitions: usize,
        /// How long each pause is.
        #[arg(long, default_value = "2", value_parser = parse_seconds)]
        pause: Duration,
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
        #[arg(long, default_value = "5", value_parser = parse_seconds)]
        seconds: Duration,
    },
    /// Measure the delay from one publisher to eight subscribers at 1000 Hz, while all run and while one is stopped.
    ///
    /// Measured at the other seven. Baseline: a PUB socket of `zeromq` for all eight.
    Fanout {
        /// How long each line is measured.
        #[arg(long, default_value = "5", value_parser = parse_seconds)]
        seconds: Duration,
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
    GatewayGrowth(GatewayGrowthOptions),
}

impl BenchArguments {
    /// Runs the benchmark and returns its report in the requested format.
    ///
    /// # Errors
    ///
    /// This program was built without what the benchmark needs, the folder for temporary files cannot be used, a
    /// process cannot be started, or a connection fails.
    pub fn measure(&self) -> scl::Result<String> {
        self.cores.pin()?;
        let report = self.benchmark.measure(self.quick)?.with_cores(self.cores);
        Ok(match (self.json, self.histogram) {
            (true, _) => format!("{:#}\n", report.to_json()),
            (false, true) => format!("{report:#}"),
            (false, false) => report.to_string(),
        })
    }
}

impl Benchmark {
    fn measure(&self, quick: bool) -> scl::Result<Report> {
        let few = |number: &usize, max: usize| if quick { max.min(*number) } else { *number };
        let short = |time: &Duration| if quick { Duration::from_millis(50).min(*time) } else { *time };
        match self {
            Self::Roundtrip { bytes, messages, transport } => {
                roundtrip::measure_roundtrip(&sizes(bytes, *transport), few(messages, 50), *transport)
            }
            Self::Rate { bytes, messages, transport } => {
                rate::measure_rate(&sizes(bytes, *transport), few(messages, 50), *transport)
            }
            Self::Fresh { repetitions, pause } => fresh::measure_fresh(few(repetitions, 2), short(pause)),
            Self::Restart { restarts } => restart::measure_restart(few(restarts, 1)),
            Self::Delay { seconds } => delay::measure_delay(short(seconds)),
            Self::Fanout { seconds } => fanout::measure_fanout(short(seconds)),
            Self::Codecs { messages } => codecs::measure_codecs(few(messages, 50)),
            Self::GatewayGrowth(options) => measure_gateway_growth(&GatewayGrowthOptions {
                connections: options.connections.iter().map(|number| few(number, 3)).collect(),
                hosts: options.hosts,
                seconds: short(&options.seconds),
                messages: few(&options.messages, 50),
            }),
        }
    }
}

/// The message sizes to measure: those given, or the defaults of a transport.
fn sizes(given: &[usize], transport: Transport) -> Vec<usize> {
    match (given, transport) {
        ([], Transport::Shm) => vec![1 << 10, 64 << 10, 4 << 20],
        ([], _) => vec![20, 1 << 10, 64 << 10],
        (given, _) => given.to_vec(),
    }
}
