//! The components of this benchmark.

scl::topology!("restart.yaml");
