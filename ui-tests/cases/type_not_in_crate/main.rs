//! The crate exists, but has no such type.

scl::topology!("topology.yaml");

#[scl::main]
async fn main(gps: Gps) -> scl::Result<()> {
    drop(gps);
    Ok(())
}
