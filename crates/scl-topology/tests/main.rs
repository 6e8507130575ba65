//! The integration tests of the crate, in one binary.

mod deadlocks_page;
mod mutations;
mod robustness;
