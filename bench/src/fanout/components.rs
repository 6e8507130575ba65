//! The components of this benchmark.

scl::topology!("fanout.yaml");
