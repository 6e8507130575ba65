//! What the programs and the tests share: components and messages of `topology.yaml`, and the control loop.

pub mod controller;

scl::topology!("topology.yaml", testable = true);
