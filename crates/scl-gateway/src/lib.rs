//! Connects the components of an SCL system that run on several hosts.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod deployment;
pub mod keys;
pub mod local;
mod pump;
pub mod route;
mod slot;
pub mod wire;

// Unit tests include `tests/wire/certificates.rs`, which names this crate `scl_gateway`.
#[cfg(test)]
extern crate self as scl_gateway;
