//! The components of this benchmark.

scl::topology!("open.yaml");
