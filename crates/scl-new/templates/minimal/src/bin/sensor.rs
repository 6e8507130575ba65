//! Publishes a made-up speed ten times a second.

use std::thread::sleep;
use std::time::Duration;

use rover::Measurement;

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut sensor: Sensor) -> scl::Result<()> {
    for step in 0.. {
        let speed = 1.0 + f64::from(step).sin();
        sensor.measurements.send_blocking(&Measurement { speed })?;
        sleep(Duration::from_millis(100));
    }
    Ok(())
}
