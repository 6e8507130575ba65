//! The Rust parts of the OSPECORR radio: a simulated spectrum, the radio, and the resource map.

#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod band;
pub mod radio;
pub mod resource_map;
pub mod spectrum;

scl::topology!("topology.yaml", testable = true);
