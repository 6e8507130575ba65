//! Applies each set-point; a program without async.

scl::topology!("topology.yaml");

#[scl::main]
fn main(mut actuator: Actuator) -> scl::Result<()> {
    loop {
        let setpoint = actuator.setpoint.recv_blocking()?;
        println!("throttle {:+.2}", setpoint.throttle);
    }
}
