//! A publisher at 1 kHz and its subscriber, to measure the overhead of tools:
//! `cargo run --release -p scl-observe --example ticks`.
//!
//! Prints every two seconds how long messages took from gate to gate.

use scl::plan::SystemPlan;
use scl::untyped::Component;
use std::time::{Duration, Instant, SystemTime};

const PERIOD: Duration = Duration::from_millis(1);

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let plan =
        std::env::args().nth(1).ok_or("usage: ticks PLAN, the output of `scl plan`: sensor.ticks to viewer.ticks")?;
    let plan = SystemPlan::from_json(&std::fs::read_to_string(plan)?)?;
    let mut viewer = Component::open_blocking(plan.component("viewer")?)?;
    let mut received = viewer.subscriber("ticks")?;
    let mut sensor = Component::open_blocking(plan.component("sensor")?)?;
    let mut sent = sensor.publisher("ticks")?;
    sensor.ready_blocking(Duration::from_secs(5))?;
    std::thread::spawn(move || {
        let start = Instant::now();
        for number in 0.. {
            std::thread::sleep((start + PERIOD * number).saturating_duration_since(Instant::now()));
            let _ = sent.send_blocking(&now_ns().to_le_bytes().to_vec().into());
        }
    });
    loop {
        let mut delays = Vec::new();
        while delays.len() < 2000 {
            let message = received.recv_blocking()?;
            delays.push(now_ns().saturating_sub(u64::from_le_bytes(message[..8].try_into()?)));
        }
        delays.sort_unstable();
        let us = |index: usize| delays[index] / 1000;
        println!("delay p50 {} us, p90 {} us, p99 {} us", us(1000), us(1800), us(1980));
    }
}

fn now_ns() -> u64 {
    SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |now| now.as_nanos() as u64)
}
