//! `scl hz`: how often gates send.

use crate::measure::{MeasureArguments, Shown, measure};
use crate::quantity::{duration, frequency};
use clap::Args;
use scl_observe::{RateFigures, RateMeter, Spread};
use serde_json::{Value, json};
use std::num::NonZeroUsize;
use std::process::ExitCode;

/// Show how often gates send: rate, periods between messages, jitter, and messages that were missed.
///
/// Messages are counted at the gate's tap, and not decoded. Periods are measured by the sender's time stamps, so they
/// do not contain the delay until a message arrives here. The jitter is the standard deviation of the period. Messages
/// that this program was too slow to see count as lost; no subscriber loses anything by that.
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
pub(crate) fn hz(arguments: &HzArguments) -> ExitCode {
    let window = arguments.window.map(NonZeroUsize::get);
    measure(&arguments.measure, &arguments.gates, move || RateMeter::new(window))
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

/// A distribution of times in milliseconds.
pub(crate) fn spread_ms(spread: &Spread) -> Value {
    let ms = |ns: i64| ns as f64 / 1e6;
    json!({
        "min": ms(spread.min),
        "p50": ms(spread.p50),
        "p99": ms(spread.p99),
        "max": ms(spread.max),
        "mean": spread.mean / 1e6,
    })
}
