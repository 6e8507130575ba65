//! The plan of a component: everything a program needs to run it, as owned values and as JSON.
//!
//! `scl-topology` makes plans from a checked topology. Generated code contains them as constants, `scl::untyped` opens
//! a component from one at run time, and `scl plan` prints them: the JSON text is the only thing of SCL that programs
//! in other languages have to read. This crate knows neither YAML nor sockets nor files, so a finished program may
//! contain it.
//!
//! The JSON text needs the feature `json`, which is off by default: the macros use the values only.
//!
//! # Example
//!
//! ```
//! # #[cfg(feature = "json")] {
//! use scl_plan::SystemPlan;
//!
//! let text = r#"{
//!   "version": 1,
//!   "system": "rover",
//!   "components": [
//!     {"name": "clock", "declared_at": "rover.yaml:2:5", "schema": null, "gates": []}
//!   ],
//!   "schemas": {}
//! }"#;
//! let system = SystemPlan::from_json(text)?;
//! assert_eq!(system.component("clock")?.gates.len(), 0);
//!
//! let error = system.component("clok").unwrap_err();
//! assert_eq!(error.to_string(), "system `rover` has no component `clok`; did you mean `clock`?");
//! # }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

#[cfg(feature = "json")]
mod base64;
mod counterpart;
mod error;
#[cfg(feature = "json")]
mod json;
mod kind;
pub mod memory;
#[cfg(feature = "json")]
mod nanoseconds;
mod options;
mod parameter;
mod plan;
mod system;
#[cfg(all(test, feature = "json"))]
mod tests;
mod validate;
#[cfg(feature = "json")]
mod version;

pub use error::{PlanError, UnknownComponent};
pub use kind::{GateKind, Undecodable, WhenFull};
pub use options::{GateOptions, OptionAccess, OptionField};
pub use parameter::{
    Assignment, ConstText, LONGEST_VALUE, ParameterPlan, ParameterType, ParameterValue, SET_SOCKET, SET_VARIABLE,
    Scalar, assignments, list_text, set_text,
};
pub use plan::{ConnectionPlan, GatePlan, Payload, Plan, Schema};
pub use system::{KindPlan, SystemPlan};
#[cfg(feature = "json")]
pub use version::VERSION;
