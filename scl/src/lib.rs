//! Typed components and gates.
pub mod spec;
