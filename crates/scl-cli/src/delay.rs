//! `scl delay`: how long messages of a gate are on their way.

use crate::hz::spread_ms;
use crate::measure::{MeasureArguments, Shown, measure};
use crate::quantity::duration;
use clap::Args;
use scl_observe::{DelayFigures, DelayMeter, Spread};
use serde_json::{Value, json};
use std::process::ExitCode;

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
pub(crate) fn delay(arguments: &DelayArguments) -> ExitCode {
    measure(&arguments.measure, &arguments.gates, DelayMeter::default)
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
                "{} of {} delays are negative: the clock was set meanwhile, or the clocks of two hosts differ",
                figures.negative, figures.messages
            )
        })
    }
}
