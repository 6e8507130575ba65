//! The integration tests of the generators, in one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod all_topologies;
mod c;
mod c_programs;
mod clashes;
mod cpp;
mod cpp_names;
mod fixture;
mod python;
mod testable;
mod writing;
mod zmq;
