//! The controller of `docs/tutorial.md`: pushes while the rover is slower than one metre a second, and brakes
//! otherwise.

use rover::Setpoint;

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut controller: Controller) -> scl::Result<()> {
    loop {
        let measured = controller.sensor.recv_blocking()?;
        controller.actuator.send_blocking(&Setpoint { throttle: 1.0 - measured.speed })?;
    }
}
