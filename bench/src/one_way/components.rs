//! The two components of these scenarios.

scl::topology!("one_way.yaml");
