//! The tests of generated code that compile it with the messages of its schemas, for which protoc and libraries are
//! needed.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod c;
mod c_programs;
mod cpp;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../fixture.rs"]
mod fixture;
mod names;
mod parameters;
mod testable;
