//! Each of three mistakes is told, and the program below causes no further one.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
