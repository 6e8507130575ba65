//! The components of this benchmark.

scl::topology!("fresh.yaml");
