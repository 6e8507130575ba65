//! Publishes a made-up speed ten times a second.

use std::time::Duration;

use rover_system::Sensor;
use rover_system::rover::Measurement;

#[scl::main]
async fn main(mut sensor: Sensor) -> scl::Result<()> {
    let mut tick = scl::time::interval(Duration::from_millis(100))?;
    for step in 0.. {
        tick.tick().await?;
        let speed = 1.0 + f64::from(step).sin();
        println!("speed {speed:.2} m/s");
        sensor.measurements.send(&Measurement { speed }).await?;
    }
    Ok(())
}
