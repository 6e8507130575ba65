//! Typed components and gates.
pub mod codec;
pub mod spec;
