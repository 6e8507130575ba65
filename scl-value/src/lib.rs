//! Messages without their Rust types: decoding, encoding, fields, conditions.
#![cfg_attr(test, allow(clippy::unwrap_used))]
