//! The same system without a gateway: what the others are compared with.

pub(crate) fn check() {}
