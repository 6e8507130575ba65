//! The program receives from a gate that sends.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.actuator.recv().await?;
        c.actuator.send(&rover::Setpoint { angle: measured.data }).await?;
    }
}
