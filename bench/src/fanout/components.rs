//! The nine components of this scenario.

scl::topology!("fanout.yaml");
