//! The component has another name in the file.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controler) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
