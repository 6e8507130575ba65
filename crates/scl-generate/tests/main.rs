//! The integration tests of the generators, in one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod all_topologies;
mod clashes;
mod cpp_names;
#[allow(dead_code, reason = "the tests with tools use the rest")]
mod fixture;
mod parameters;
mod python;
mod writing;
mod zmq;
