//! The tests of the C library that take more than a C compiler: valgrind, and protoc-c for the examples of the
//! documentation.
#![allow(clippy::unwrap_used)]

mod leaks;
mod page;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../programs.rs"]
mod programs;
