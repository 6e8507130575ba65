//! `scl hz`, `scl delay` and `scl bw`: how often gates send, how long messages are on their way, and how many bytes.

use crate::measure::{MeasureArguments, Shown, measure};
use crate::quantity::{duration, frequency};
use clap::Args;
use scl_observe::{
    BandwidthFigures, BandwidthMeter, DelayFigures, DelayMeter, RateFigures, RateMeter, Spread, block_on,
};
use scl_terminal::{Problem, bytes_text};
use serde_json::{Value, json};
use std::num::NonZeroUsize;
use std::process::ExitCode;

/// Show how often gates send: rate, periods between messages, jitter, and messages that were missed.
///
/// Messages are counted at the gate's tap, and not decoded. Periods are measured by the sender's time stamps, so they
/// do not contain the delay until a message arrives here. The jitter is the standard deviation of the period. Messages
/// that this program was too slow to see count as lost; subscribers are not affected.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl hz                                 all gates, a table each second
  scl hz sensor.measurements             one gate, a line each second
  scl hz sensor.measurements --window 100
  scl hz --once --for 10s --format json  ten seconds, one JSON object for each gate

Exit code: 0 measured, 1 no message was seen, 2 no such gate or system, or it is not running.")]
pub(crate) struct HzArguments {
    /// The gates, as `component.gate`; all if none is named. At a gate that receives, its senders are measured.
    gates: Vec<String>,
    /// Show the figures of the last N messages instead of those of the last second.
    #[arg(long, value_name = "N")]
    window: Option<NonZeroUsize>,
    #[command(flatten)]
    measure: MeasureArguments,
}

/// The body of `scl hz`.
pub(crate) fn hz(arguments: &HzArguments) -> Result<ExitCode, Problem> {
    let window = arguments.window.map(NonZeroUsize::get);
    block_on(measure(&arguments.measure, &arguments.gates, move || RateMeter::new(window)))
}

impl Shown for RateMeter {
    const COLUMNS: &'static [(&'static str, usize)] =
        &[("RATE", 8), ("MIN", 7), ("P50", 7), ("P99", 7), ("MAX", 7), ("JITTER", 7), ("LOST", 4)];

    fn cells(figures: &RateFigures) -> Option<Vec<String>> {
        let RateFigures { messages, rate, period, lost } = figures;
        let of_period = |value: fn(&Spread) -> f64| period.as_ref().map_or("-".to_owned(), |it| duration(value(it)));
        (*messages > 0).then(|| {
            vec![
                rate.map_or("-".to_owned(), frequency),
                of_period(|it| it.min as f64),
                of_period(|it| it.p50 as f64),
                of_period(|it| it.p99 as f64),
                of_period(|it| it.max as f64),
                of_period(|it| it.deviation),
                lost.to_string(),
            ]
        })
    }

    fn json(figures: &RateFigures) -> Value {
        let RateFigures { messages, rate, period, lost } = figures;
        json!({
            "messages": messages,
            "rate_hz": rate,
            "period_ms": period.as_ref().map(spread_ms),
            "jitter_ms": period.map(|period| period.deviation / 1e6),
            "lost": lost,
        })
    }
}

/// Show how long messages take from being sent until this program sees them.
///
/// A `pub` gate's messages are stamped when they are sent, those of a `pull` or `rep` gate when they are received. Both
/// times are of the real-time clock, so a clock that is set while messages are on their way, or that differs between
/// two hosts, makes the delay wrong and perhaps negative.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl delay sensor.measurements
  scl delay sensor.measurements --once --for 10s --format json

Exit code: 0 measured, 1 no message was seen, 2 no such gate or system, or it is not running.")]
pub(crate) struct DelayArguments {
    /// The gates, as `component.gate`.
    #[arg(required = true)]
    gates: Vec<String>,
    #[command(flatten)]
    measure: MeasureArguments,
}

/// The body of `scl delay`.
pub(crate) fn delay(arguments: &DelayArguments) -> Result<ExitCode, Problem> {
    block_on(measure(&arguments.measure, &arguments.gates, DelayMeter::default))
}

impl Shown for DelayMeter {
    const COLUMNS: &'static [(&'static str, usize)] =
        &[("MESSAGES", 8), ("MIN", 7), ("P50", 7), ("P99", 7), ("MAX", 7), ("MEAN", 7)];

    fn cells(figures: &DelayFigures) -> Option<Vec<String>> {
        let spread = figures.delay.as_ref()?;
        let Spread { min, p50, p99, max, mean, .. } = *spread;
        let delays = [min as f64, p50 as f64, p99 as f64, max as f64, mean];
        Some([figures.messages.to_string()].into_iter().chain(delays.map(duration)).collect())
    }

    fn json(figures: &DelayFigures) -> Value {
        json!({
            "messages": figures.messages,
            "delay_ms": figures.delay.as_ref().map(spread_ms),
            "negative": figures.negative,
        })
    }

    fn remark(figures: &DelayFigures) -> Option<String> {
        (figures.negative > 0).then(|| {
            format!(
                "{} of {} delays are negative: the clock was set while measuring, or the clocks of two hosts differ",
                figures.negative, figures.messages
            )
        })
    }
}

/// Show how many bytes gates send in a second, and the sizes of their messages.
///
/// Counts the bytes of the encoded messages, requests and replies, without those of the protocol. A message to
/// three subscribers counts once.
#[derive(Args)]
#[command(after_help = "\
Examples:
  scl bw                                   all gates, a table each second
  scl bw sensor.image
  scl bw sensor.image --once --format json

Exit code: 0 measured, 1 no message was seen, 2 no such gate or system, or it is not running.")]
pub(crate) struct BwArguments {
    /// The gates, as `component.gate`; all if none is named.
    gates: Vec<String>,
    #[command(flatten)]
    measure: MeasureArguments,
}

/// The body of `scl bw`.
pub(crate) fn bw(arguments: &BwArguments) -> Result<ExitCode, Problem> {
    block_on(measure(&arguments.measure, &arguments.gates, BandwidthMeter::default))
}

impl Shown for BandwidthMeter {
    const COLUMNS: &'static [(&'static str, usize)] =
        &[("BANDWIDTH", 10), ("MESSAGES", 8), ("MIN", 8), ("MEAN", 8), ("MAX", 8)];

    fn cells(figures: &BandwidthFigures) -> Option<Vec<String>> {
        let (min, mean, max) = figures.size?;
        Some(vec![
            figures.per_second.map_or("-".to_owned(), |rate| format!("{}/s", bytes_text(rate))),
            figures.messages.to_string(),
            bytes_text(min as f64),
            bytes_text(mean),
            bytes_text(max as f64),
        ])
    }

    fn json(figures: &BandwidthFigures) -> Value {
        json!({
            "messages": figures.messages,
            "bytes": figures.bytes,
            "bytes_per_second": figures.per_second,
            "size": figures.size.map(|(min, mean, max)| json!({"min": min, "mean": mean, "max": max})),
        })
    }
}

/// A distribution of times in milliseconds.
fn spread_ms(spread: &Spread) -> Value {
    let ms = |ns: i64| ns as f64 / 1e6;
    json!({
        "min": ms(spread.min),
        "p50": ms(spread.p50),
        "p99": ms(spread.p99),
        "max": ms(spread.max),
        "mean": spread.mean / 1e6,
    })
}
