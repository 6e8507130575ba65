//! A controller without async that stops the motors before it ends.

use scl::RecvTimeoutError;
use std::time::Duration;

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut c: Controller) -> scl::Result<()> {
    while !scl::is_stop_requested() {
        match c.sensor.recv_timeout(Duration::from_millis(100)) {
            Ok(measured) => c.actuator.send_blocking(&rover::Setpoint { throttle: 1.0 - measured.speed })?,
            Err(RecvTimeoutError::Timeout { .. }) => {}
            Err(error) => return Err(error.into()),
        }
    }
    c.actuator.send_blocking(&rover::Setpoint { throttle: 0.0 })?;
    Ok(())
}
