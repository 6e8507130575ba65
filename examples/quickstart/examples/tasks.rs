//! A controller whose gates are used in separate tasks.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

scl::topology!("topology.yaml");

#[scl::main]
async fn main(c: Controller) -> scl::Result<()> {
    let Controller { mut sensor, mut actuator, mut commands, .. } = c;
    let target = Arc::new(AtomicU64::new(1.0_f64.to_bits()));

    let commanded = Arc::clone(&target);
    let commanding = tokio::spawn(async move {
        loop {
            let command = commands.recv().await?;
            commanded.store(command.target_speed.to_bits(), Ordering::Relaxed);
            let _gone = command.reply(&rover::Status { accepted: true, reason: String::new() });
        }
    });
    let steering = tokio::spawn(async move {
        loop {
            let target_speed = f64::from_bits(target.load(Ordering::Relaxed));
            let throttle = target_speed - sensor.recv().await?.speed;
            actuator.send(&rover::Setpoint { throttle }).await?;
        }
    });
    // Both tasks loop forever, so the first one to end has failed.
    tokio::select! {
        result = commanding => result?,
        result = steering => result?,
    }
}
