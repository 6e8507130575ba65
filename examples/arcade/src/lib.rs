//! The Rust parts of the ARCADE aircraft: the simulated world, and an autopilot that is the twin of the one in C.

scl::topology!("topology.yaml", testable = true);
