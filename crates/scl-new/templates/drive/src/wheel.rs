//! What a wheel does. It is apart from the program so that a test can run it, too.

use std::time::Duration;

use scl::{Pub, Sub};

use crate::rover::{Setpoint, WheelState};

/// Follows the set-point, and stops when none comes in time. Each step takes a share of the way.
pub async fn run(
    mut setpoints: Sub<Setpoint>,
    mut states: Pub<WheelState>,
    response: f64,
) -> scl::Result<()> {
    let mut tick = scl::time::interval(Duration::from_millis(50))?;
    let (mut target, mut speed) = (0.0, 0.0);
    loop {
        tokio::select! {
            missed = setpoints.deadline_missed() => {
                missed?;
                target = 0.0;
            }
            setpoint = setpoints.recv() => target = setpoint?.speed,
            ticked = tick.tick() => {
                ticked?;
                // A motor takes its time.
                speed += (target - speed) * response;
                states.send(&WheelState { speed }).await?;
            }
        }
    }
}
