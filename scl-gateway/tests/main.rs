//! The gateway as processes on real networks.
#![allow(clippy::unwrap_used)]

mod local;
