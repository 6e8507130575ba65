//! `main` returns something that is no result.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(mut c: Controller) -> Result<u8, String> {
    c.sensor.recv().await.map_err(|error| error.to_string())?;
    Ok(1)
}
