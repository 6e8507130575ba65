//! The Rust parts of the ARCADE aircraft: the simulated world, and an autopilot that is the twin of the one in C.

pub mod autopilot;
pub mod flight_loop;
pub mod geodesy;
pub mod nmea;
pub mod sensors;
pub mod serial;
pub mod simulation;
pub mod simulator;
pub mod watch;
pub mod world;

scl::topology!("topology.yaml", testable = true);
