//! The module exists, but has no such type.

mod nav {}

scl::topology!("topology.yaml");

#[scl::main]
async fn main(gps: Gps) -> scl::Result<()> {
    drop(gps);
    Ok(())
}
