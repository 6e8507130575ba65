//! A bracket is never closed.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
