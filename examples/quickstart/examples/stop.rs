//! A controller that stops the motors before it ends.

use std::time::Duration;

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    tokio::select! {
        result = steer(&mut c) => return result,
        () = scl::stop_requested() => {}
    }
    c.actuator.send(&rover::Setpoint { throttle: 0.0 }).await?;
    c.close(Duration::from_secs(1)).await?;
    Ok(())
}

async fn steer(c: &mut Controller) -> scl::Result<()> {
    loop {
        let throttle = 1.0 - c.sensor.recv().await?.speed;
        c.actuator.send(&rover::Setpoint { throttle }).await?;
    }
}
