//! A schema does not compile: rustc must not say that its messages do not exist.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured: rover::Measurement = c.sensor.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
