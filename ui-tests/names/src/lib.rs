//! Random systems with awkward names, each in a module of its own. That this compiles is the test: `scl check` accepted
//! them all.
//!
//! `SCL_TEST_SCHEMAS=1000 cargo test -p scl-name-tests` tries more.
#![allow(deprecated, reason = "warnings of the macro")]

include!(concat!(env!("OUT_DIR"), "/systems.rs"));
