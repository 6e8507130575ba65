//! Typed components and gates.
pub mod codec;
pub mod place;
pub mod spec;
