//! What the programs and the tests share: components and messages of `topology.yaml`, and what the programs do.

pub mod chassis;
pub mod wheel;

scl::topology!("topology.yaml", testable = true);
