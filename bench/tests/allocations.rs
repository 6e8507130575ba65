//! How many allocations a message takes, beside the raw sockets: counted, not timed, so it is a test and not a figure.
//!
//! It has a `main` of its own because the scenarios start this program again as their other processes, and because
//! nothing else may allocate meanwhile.

use scl_bench::{OTHER_SIDE, Rate, Roundtrip, measure_rate, measure_roundtrip, play_other_side};
use serde_json::Value;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

/// What a whole batch may allocate besides its messages, and what the threads beside it do, spread over its messages: up
/// to 0.44 was seen. One more allocation a message is always too many.
const TOLERANCE: f64 = 0.75;

fn main() -> scl_bench::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.split_first() {
        Some((first, rest)) if first == OTHER_SIDE => play_other_side(rest),
        // What `cargo test` asks of a program without the usual harness.
        Some((first, _)) if first == "--list" => Ok(()),
        _ => count(),
    }
}

fn allocations() -> u64 {
    let stats = ALLOCATOR.stats();
    (stats.allocations + stats.reallocations) as u64
}

fn count() -> scl_bench::Result<()> {
    let roundtrip = Roundtrip { bytes: vec![20], messages: 2_000, allocations: Some(allocations) };
    let roundtrip = measure_roundtrip(&roundtrip)?.to_json();
    let rate = Rate { bytes: vec![20], messages: 20_000, allocations: Some(allocations) };
    let rate = measure_rate(&rate)?.to_json();
    let mut passed = true;
    for (report, ours, raw, more) in [
        (&roundtrip, "SCL pub/sub", "zeromq XPUB/SUB", 0.0),
        (&roundtrip, "SCL pub/sub blocking", "zeromq XPUB/SUB", 0.0),
        (&roundtrip, "SCL req/rep", "zeromq DEALER/ROUTER", 0.0),
        (&roundtrip, "SCL req/rep blocking", "zeromq DEALER/ROUTER", 0.0),
        (&rate, "SCL pub/sub", "zeromq XPUB/SUB", 0.0),
        // What tells that the library has written a message, so that no more are with it than the file allows.
        (&rate, "SCL push/pull", "zeromq PUSH/PULL", 1.0),
    ] {
        let [ours_takes, raw_takes] = [ours, raw].map(|name| taken(report, name));
        println!("{}: {ours} {ours_takes:.2}, {raw} {raw_takes:.2}, allowed {more} more", report["scenario"]);
        passed &= ours_takes > 0.0 && ours_takes <= raw_takes + more + TOLERANCE;
    }
    if passed { Ok(()) } else { Err(scl_bench::Error::message("a message takes more allocations than is allowed")) }
}

fn taken(report: &Value, name: &str) -> f64 {
    let rows = report["tables"][0]["rows"].as_array().into_iter().flatten();
    let row = rows.into_iter().find(|row| row["name"] == name);
    row.and_then(|row| row["allocations"].as_f64()).unwrap_or(f64::NAN)
}
