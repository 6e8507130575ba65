//! The program sends another message than the gate carries.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> scl::Result<()> {
    loop {
        let measured = c.sensor.recv().await?;
        c.actuator.send(&measured).await?;
    }
}
