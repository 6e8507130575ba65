//! The integration tests of the generators, in one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod all_topologies;
mod c;
mod clashes;
mod fixture;
mod python;
mod writing;
mod zmq;
