//! Systems as tools see them: real components, opened in this process on a runtime folder of the test's own.
#![allow(clippy::unwrap_used, reason = "a test may panic")]

mod find;
mod gates;
mod taps;
mod world;
