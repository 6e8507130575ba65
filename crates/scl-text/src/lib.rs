//! Texts that people write and read: durations, rates, sizes, names of gates, names that were probably meant, lists of
//! names, words of enums, excerpts of long values.
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod duration;
pub mod excerpt;
pub mod gate_name;
pub mod list;
mod number;
pub mod rate;
pub mod size;
pub mod suggest;
mod words;
