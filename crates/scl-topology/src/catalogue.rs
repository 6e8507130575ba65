//! Every rule with its code, its explanation and its examples. `scl explain SCL0511` prints an entry,
//! `docs/diagnostics.md` is generated from all of them, and tests check their examples.

mod page;
#[cfg(test)]
mod tests;

pub use crate::check::{ALL, find};
pub use page::{entry, explain, page};
