//! The C++ binding: programs in `bindings/cpp/tests`, compiled by the system's compiler, with Rust programs as peers.

pub(crate) mod build;
mod checks;
mod cmake;
mod counterparts;
mod exits;
mod json;
mod misuse;
mod page;
mod parameters;
mod signals;
mod six_kinds;
