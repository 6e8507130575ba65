//! The integration tests of the generators, in one binary.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod python;
