//! Two paths look alike and are different types.

mod rover {
    #[derive(serde::Serialize, serde::Deserialize)]
    pub struct Measurement;
}

mod other {
    #[derive(serde::Serialize, serde::Deserialize)]
    pub struct Measurement;
}

scl::topology!("topology.yaml");

fn main() {}
