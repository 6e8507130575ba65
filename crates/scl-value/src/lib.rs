//! Messages without their Rust types: decoding, encoding, fields, conditions, texts.
//!
//! [`MessageType`] reads and writes the messages of one type in one codec, as [`Value`]s. What it needs to know is in a
//! component's plan: the type's name, the codec, and for protobuf the descriptor set.
//!
//! ```
//! use scl_value::{Condition, FieldPath, MessageType, read_yaml, to_json};
//!
//! let messages = MessageType::new(Some("rover.Measurement"), "json", None)?;
//! let bytes = messages.encode(&read_yaml("{speed: 1.5, unit: m/s}")?)?;
//! let value = messages.decode(&bytes)?;
//! assert_eq!(to_json(&value), r#"{"speed":1.5,"unit":"m/s"}"#);
//!
//! let speed: FieldPath = "speed".parse()?;
//! assert_eq!(speed.find(&value), Some(&1.5.into()));
//! let fast: Condition = "speed > 1.0 and unit == 'm/s'".parse()?;
//! assert!(fast.holds(&value)?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod base64;
mod condition;
mod error;
mod field_kind;
mod gate_types;
mod limits;
mod message_type;
mod path;
mod protobuf;
mod self_describing;
#[cfg(test)]
mod testing;
mod text;
mod value;

pub use condition::{Condition, ConditionError};
pub use error::{DecodeError, Mismatch, TypeError};
pub use gate_types::GateTypes;
pub use message_type::MessageType;
pub use path::{FieldPath, PathError};
pub use text::{Documents, ReadError, Table, read_yaml, to_yaml};
pub use value::{Opaque, Value, Written, key_text, to_json};
