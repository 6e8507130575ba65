//! SCL in Rust, without async: `scl_rust client|echo`.

use std::fmt::Write;
use std::io::{BufRead, stdin};
use std::time::{Duration, Instant};

scl::topology!("languages/roundtrip.yaml");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    if std::env::args().nth(1).as_deref() == Some("client") {
        return measure(&mut Client::open_blocking()?);
    }
    let mut echo = Echo::open_blocking()?;
    loop {
        let message = echo.ping.recv_blocking()?;
        echo.pong.send_blocking(&message)?;
    }
}

/// Measures batches: `run` writes a number of messages to standard input and expects the time of each round trip, in
/// nanoseconds, as one line.
fn measure(client: &mut Client) -> Result<(), Box<dyn std::error::Error>> {
    client.ready_blocking(Duration::from_secs(10))?;
    let payload = scl::bytes::Bytes::from_static(&[0; 20]);
    for line in stdin().lock().lines() {
        let count: usize = line?.trim().parse()?;
        let mut exchange = || -> scl::Result<u128> {
            let started = Instant::now();
            client.ping.send_blocking(&payload)?;
            client.pong.recv_blocking()?;
            Ok(started.elapsed().as_nanos())
        };
        // Other programs have run since the last batch, so warm the caches first.
        for _ in 0..count / 10 {
            exchange()?;
        }
        let mut durations = String::new();
        for _ in 0..count {
            write!(durations, "{} ", exchange()?)?;
        }
        println!("{durations}");
    }
    Ok(())
}
