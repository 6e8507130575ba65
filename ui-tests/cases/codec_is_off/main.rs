//! The codec's cargo feature is off.

#[derive(serde::Serialize, serde::Deserialize)]
struct Measurement;

scl::topology!("topology.yaml");

fn main() {}
