//! The topology file of SCL: text in, checked topology or every problem out.
//!
//! The stages, each with its own type, so that a later stage cannot be handed what an earlier one rejected:
//!
//! ```text
//! text --parse--> Model (as written) --check--> Topology (names resolved, no error left) --resolve--> Plan
//! ```
//!
//! This crate does no input or output: the caller reads the files and prints the diagnostics.
//!
//! # Example
//!
//! The topology of the paper's first listing:
//!
//! ```
//! use scl_topology::check::{Facts, check};
//! use scl_topology::diagnostic::{Diagnostics, render};
//! use scl_topology::parse::parse;
//! use scl_topology::source::Sources;
//!
//! let text = "\
//! components:
//!   - name: sensor
//!     gates:
//!       - measurements: pub
//!   - name: actuator
//!     gates:
//!       - setpoint: sub
//!   - name: controller
//!     gates:
//!       - sensor: sub
//!       - actuator: pub
//!       - events: pub
//!       - commands: rep
//!   - name: user_interface
//!     gates:
//!       - events: sub
//!       - commands: req
//! connections:
//!   - [sensor.measurements, controller.sensor]
//!   - [actuator.setpoint, controller.actuator]
//!   - [controller.events, user_interface.events]
//!   - [controller.commands, user_interface.commands]
//! ";
//! let mut sources = Sources::new();
//! let file = sources.add("topology.yaml", text);
//! let mut problems = Diagnostics::new();
//! let model = parse(&sources, file, &mut problems);
//! let facts = Facts { default_system: "topology".to_owned(), ..Facts::default() };
//! let topology = check(&model, &facts, &sources, &mut problems);
//! for problem in problems.into_sorted() {
//!     println!("{}", render(&problem, &sources));
//! }
//! assert_eq!(topology.map(|topology| topology.connections().len()), Some(4));
//! ```
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod advice;
#[cfg(test)]
mod cases;
pub mod catalogue;
pub mod check;
mod confusable;
#[cfg(test)]
mod cost;
pub mod diagnostic;
mod everyone;
pub mod external;
pub mod fingerprint;
pub mod grammar;
pub mod groups;
mod habits;
pub mod join;
pub mod keywords;
mod kinds;
pub mod memory;
pub mod model;
pub mod parse;
pub mod resolve;
pub mod rust_name;
pub mod senders;
pub mod socket_paths;
pub mod source;
mod spelling;
pub mod suggest;
pub mod topology;
mod work;
pub mod yaml;
