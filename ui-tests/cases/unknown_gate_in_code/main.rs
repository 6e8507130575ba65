//! The program names a gate that is nearly one.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuater.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
