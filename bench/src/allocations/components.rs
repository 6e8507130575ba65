//! The components of this benchmark.

use super::reading;

scl::topology!("allocations.yaml");
