//! The two components of this scenario.

scl::topology!("open.yaml");
