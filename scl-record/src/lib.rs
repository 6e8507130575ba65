//! Recording, replay and comparison of systems, in MCAP files.
#![cfg_attr(test, allow(clippy::unwrap_used))]
