//! The topology file of SCL: text in, checked topology or every problem out.
//!
//! The stages, each with its own type, so that a later stage cannot be handed what an earlier one rejected:
//!
//! ```text
//! text --parse--> Model (as written) --check--> Topology (names resolved, no error left) --resolve--> endpoints
//! ```
//!
//! This crate does no input or output: the caller reads the files and prints the diagnostics.
#![deny(missing_docs)]

pub mod diagnostic;
pub mod model;
pub mod parse;
pub mod source;
mod suggest;
pub mod topology;
mod yaml;
