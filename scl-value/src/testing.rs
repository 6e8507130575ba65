//! Types for the tests of this crate.
