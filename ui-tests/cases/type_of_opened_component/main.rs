//! The program opens the camera, whose messages it does not know. The types of the GPS alone would be no problem.

mod nav {
    #[derive(serde::Serialize, serde::Deserialize)]
    pub struct Fix;
}

scl::topology!("topology.yaml");

#[scl::main]
async fn main(camera: Camera) -> scl::Result<()> {
    let _gps = Gps::open().await?;
    drop(camera);
    Ok(())
}
