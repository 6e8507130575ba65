//! The two components of this scenario.

scl::topology!("roundtrip.yaml");
