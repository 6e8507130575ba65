//! The Rust parts of the ARCADE aircraft: the simulated world, and an autopilot that is the twin of the one in C.

pub mod autopilot;
pub mod geodesy;
pub mod sensors;
pub mod simulation;
pub mod world;

scl::topology!("topology.yaml", testable = true);
