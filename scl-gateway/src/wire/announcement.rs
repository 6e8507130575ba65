//! Announcements: components that run, with their plans and schemas.

/// A component is announced while this exists.
#[derive(Debug)]
#[must_use = "the component is announced only until this is dropped"]
pub struct Announced {}
