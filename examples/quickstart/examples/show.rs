//! The display of `docs/tutorial.md`, here as the rover's actuator: shows each set-point.

use rover::Setpoint;

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut display: Actuator) -> scl::Result<()> {
    loop {
        println!("{}", line(&display.setpoint.recv_blocking()?));
    }
}

fn line(setpoint: &Setpoint) -> String {
    format!("throttle {:+.2}", setpoint.throttle)
}
