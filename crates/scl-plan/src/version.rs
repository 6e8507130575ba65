//! The version of the JSON format.

/// The version of the format. It grows with every change, because readers accept no unknown field. `kinds`, which only
/// some systems have, came without: an earlier reader refuses it by its name.
pub const VERSION: u64 = 1;
