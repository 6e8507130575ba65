//! A type cannot be carried by the codec.

mod rover {
    pub struct Measurement;
}

scl::topology!("topology.yaml");

fn main() {}
