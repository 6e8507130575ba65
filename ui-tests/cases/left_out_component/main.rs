//! The component is left out by `only`.

scl::topology!("topology.yaml", only = [sensor, actuator]);

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
