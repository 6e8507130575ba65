//! Templates of new projects: what `scl new` writes.
#![cfg_attr(test, allow(clippy::unwrap_used))]
