//! A sensor in a program that has its own `main` and chooses its own runtime.

use std::time::Duration;

scl::topology!("topology.yaml");

#[tokio::main(flavor = "multi_thread", worker_threads = 2)]
async fn main() -> scl::Result<()> {
    let mut sensor = Sensor::open().await?;
    sensor.ready(Duration::from_secs(10)).await?;
    for step in 0..100_u64 {
        // What computes for long or waits for hardware runs beside the runtime.
        let speed = tokio::task::spawn_blocking(move || read_hardware(step)).await?;
        sensor.measurements.send(&rover::Measurement { speed }).await?;
    }
    sensor.close(Duration::from_secs(1)).await?;
    Ok(())
}

fn read_hardware(step: u64) -> f64 {
    std::thread::sleep(Duration::from_millis(10));
    1.0 + (step as f64).sin()
}
