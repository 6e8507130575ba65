//! Connects the components of an SCL system that run on several hosts.

pub mod route;
pub mod wire;
