//! The attribute needs to know the component.

scl::topology!("topology.yaml");

#[scl::main]
async fn main() {}
