//! No role allocates per message in the steady state. Allocations are counted, not timed, so this is a test.
//!
//! It has its own `main` because the benchmark starts this program again as its worker processes, and because nothing
//! else may allocate meanwhile.

use scl_bench::{WORKER_COMMAND, measure_allocations, run_worker};
use serde_json::Value;
use stats_alloc::{INSTRUMENTED_SYSTEM, StatsAlloc};
use std::alloc::System;

#[global_allocator]
static ALLOCATOR: &StatsAlloc<System> = &INSTRUMENTED_SYSTEM;

const MESSAGES: usize = 20_000;

/// Per 1000 messages: a buffer that many messages share may be allocated again, but nothing for each of them.
const TOLERANCE: f64 = 10.0;

const ROLES: [&str; 7] =
    ["SCL pub", "SCL sub", "SCL push", "SCL pull", "SCL req", "SCL rep", "SCL pub and sub, in turn"];

const BASELINE: &str = "Unix socket, round trip";

fn main() -> scl_bench::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.split_first() {
        Some((first, rest)) if first == WORKER_COMMAND => run_worker(rest),
        // `cargo test` asks for a list of tests, which a program without the usual harness does not have.
        Some((first, _)) if first == "--list" => Ok(()),
        _ => check(),
    }
}

fn allocations() -> u64 {
    let stats = ALLOCATOR.stats();
    (stats.allocations + stats.reallocations) as u64
}

fn check() -> scl_bench::Result<()> {
    let report = measure_allocations(MESSAGES, allocations)?;
    print!("{report}");
    let report = report.to_json();
    let mut failed = Vec::new();
    for call in ["async", "blocking"] {
        // What tokio allocates by itself is not counted against SCL.
        let allowed = allocations_of(&report, BASELINE, call)? + TOLERANCE;
        for role in ROLES {
            let allocations = allocations_of(&report, role, call)?;
            if allocations > allowed {
                failed.push(format!("{role}, {call}: {allocations}"));
            }
        }
    }
    if failed.is_empty() {
        return Ok(());
    }
    Err(scl_bench::Error::message(format!("allocations per 1000 messages: {}", failed.join("; "))))
}

fn allocations_of(report: &Value, role: &str, call: &str) -> scl_bench::Result<f64> {
    let rows = report["tables"][0]["rows"].as_array().into_iter().flatten();
    let row = rows.into_iter().find(|row| row["name"] == role);
    let missing = || scl_bench::Error::message(format!("the report has no line `{role}`"));
    row.and_then(|row| row[call].as_f64()).ok_or_else(missing)
}
