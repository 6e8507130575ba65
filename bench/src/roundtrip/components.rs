//! The components of this benchmark.

scl::topology!("roundtrip.yaml");
