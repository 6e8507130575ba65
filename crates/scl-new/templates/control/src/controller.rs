//! The control loop. It is apart from the program so that a test can run it, too.

use std::time::Duration;

use tokio::time::timeout;

use crate::Controller;
use crate::rover::{Event, Setpoint, Status};

/// The motors stop if no measurement arrives for this long.
pub const SENSOR_TIMEOUT: Duration = Duration::from_millis(500);

/// Metres a second.
pub const MAX_SPEED: f64 = 2.0;

/// Steers towards the speed that was last asked for.
pub async fn run(mut c: Controller) -> scl::Result<()> {
    let mut target_speed = 1.0;
    loop {
        tokio::select! {
            measured = timeout(SENSOR_TIMEOUT, c.sensor.recv()) => {
                let throttle = match measured {
                    Ok(measured) => (target_speed - measured?.speed).clamp(-1.0, 1.0),
                    Err(_elapsed) => 0.0,
                };
                c.setpoints.send(&Setpoint { throttle }).await?;
            }
            command = c.commands.recv() => {
                let command = command?;
                let status = check(command.target_speed);
                if status.accepted {
                    target_speed = command.target_speed;
                    let text = format!("target is now {target_speed:.1} m/s");
                    c.events.send(&Event { text }).await?;
                }
                // A caller that has been stopped no longer waits for the reply.
                let _gone = command.reply(&status);
            }
        }
    }
}

/// The reply to a command.
fn check(target_speed: f64) -> Status {
    let accepted = (0.0..=MAX_SPEED).contains(&target_speed);
    let mut reason = String::new();
    if !accepted {
        reason = format!("not between 0 and {MAX_SPEED} m/s");
    }
    Status { accepted, reason }
}
