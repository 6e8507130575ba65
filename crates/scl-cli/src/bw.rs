//! `scl bw`: how many bytes gates send.

use crate::measure::{MeasureArguments, Shown, measure};
use clap::Args;
use scl_observe::{BandwidthFigures, BandwidthMeter};
use scl_terminal::bytes_text;
use serde_json::{Value, json};
use std::process::ExitCode;

/// Show how many bytes gates send in a second, and the sizes of their messages.
///
/// Counted are the bytes of the encoded messages, requests and replies, without those of the protocol. A message to
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
pub(crate) fn bw(arguments: &BwArguments) -> ExitCode {
    measure(&arguments.measure, &arguments.gates, BandwidthMeter::default)
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
