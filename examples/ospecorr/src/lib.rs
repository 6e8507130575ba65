//! The Rust parts of the OSPECORR radio: a simulated spectrum, the radio, and the resource map.

scl::topology!("topology.yaml", testable = true);
