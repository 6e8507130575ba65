//! Every rule with its code, its explanation and its examples. `scl explain SCL0511` prints an entry,
//! `docs/diagnostics.md` is generated from it, and the tests hold each entry to what it says.

mod page;
#[cfg(test)]
mod tests;

pub use crate::check::{ALL, find};
pub use page::{entry, explain, page};
