//! `scl bench`: SCL beside its raw parts on this machine.

use crate::duration::parse_duration;
use crate::print::{print_err, print_out};
use clap::{Args, Subcommand};
use scl_bench::{Codecs, Delay, Fanout, Open, Rate, Report, Roundtrip};
use std::process::ExitCode;
use std::time::Duration;

/// The hidden word with which a scenario starts its other processes.
pub(crate) const OTHER_SIDE_WORD: &str = scl_bench::OTHER_SIDE;

/// Measure SCL on this machine, beside the raw sockets and libraries that it is made of.
#[derive(Args)]
#[command(after_help = "What else runs on the machine shows in absolute times; the ratios to the raw parts stay.")]
pub(crate) struct BenchArguments {
    #[command(subcommand)]
    scenario: Scenario,
    /// Print one JSON object instead of tables.
    #[arg(long, global = true)]
    json: bool,
    /// Print below each table how its times are distributed: the last percents, and a picture of all of them.
    #[arg(long, global = true, conflicts_with = "json")]
    histogram: bool,
    /// Measure next to nothing: enough to see that everything runs.
    #[arg(long, global = true, hide = true)]
    quick: bool,
}

#[derive(Subcommand)]
enum Scenario {
    /// The time of a message to another process and back, by publishing and by asking, async and blocking.
    Roundtrip {
        /// The lengths of the messages, in bytes.
        #[arg(long, value_delimiter = ',', default_values_t = [20, 1024, 65536])]
        bytes: Vec<usize>,
        /// How many messages of each length go each way.
        #[arg(long, default_value_t = 20_000)]
        messages: usize,
    },
    /// Messages a second from one process to another, none lost, published and pushed.
    Rate {
        /// The lengths of the messages, in bytes; at least 8.
        #[arg(long, value_delimiter = ',', default_values_t = [20, 1024])]
        bytes: Vec<usize>,
        /// How many messages of each length go each way.
        #[arg(long, default_value_t = 500_000)]
        messages: usize,
    },
    /// The delay of 20 bytes at 1000 Hz: idle, under load, and with real-time priority where that is permitted.
    Delay {
        /// How long each way is measured in each situation.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// The delay from one process to eight at 1000 Hz, while all of them run and while one of them is stopped.
    Fanout {
        /// How long each way is measured in each situation.
        #[arg(long, default_value_t = 5.0, value_parser = parse_seconds)]
        seconds: f64,
    },
    /// The time to encode and decode a record, and its length, for every codec.
    Codecs {
        /// How many records each codec encodes and decodes.
        #[arg(long, default_value_t = 100_000)]
        messages: usize,
    },
    /// The time to open a component of ten gates, its memory, and how often it wakes up when idle.
    Open {
        /// How often it is started.
        #[arg(long, default_value_t = 30)]
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
    match measure(&arguments.scenario, arguments.quick) {
        Ok(report) => {
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

/// `5`, `0.5`, or with a unit as elsewhere, `5s`.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let with_unit = if text.ends_with(|c: char| c.is_ascii_digit()) { format!("{text}s") } else { text.to_owned() };
    let time = parse_duration(&with_unit)?;
    if time < Duration::from_millis(1) || time > Duration::from_secs(3600) {
        return Err("expected between `0.001` and `3600` seconds".to_owned());
    }
    Ok(time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_need_no_unit() {
        for (text, seconds) in [("5", 5.0), ("0.5", 0.5), ("250ms", 0.25)] {
            assert_eq!(parse_seconds(text), Ok(seconds), "{text}");
        }
        for text in ["0", "-1", "2h", "five"] {
            assert!(parse_seconds(text).is_err(), "{text}");
        }
    }
}
