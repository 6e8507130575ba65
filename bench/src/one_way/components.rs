//! The components of these benchmarks.

scl::topology!("one_way.yaml");
