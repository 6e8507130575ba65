//! The version of the JSON format.

/// The version of the format. It grows with every change, because readers accept no unknown field.
pub const VERSION: u64 = 1;
