//! Messages of protobuf: from bytes and from JSON to values and back, by the description of their type.

mod check;
mod fields;
mod from_value;
mod template;
mod to_value;
mod well_known;

pub(crate) use check::Fault;
pub(crate) use fields::{columns, kind_of};
pub(crate) use from_value::{Unknown, from_value};
pub(crate) use template::template;

use crate::error::Mismatch;
use crate::value::Value;
use prost_reflect::{DynamicMessage, MessageDescriptor};

/// The key of fields that the type does not have.
const UNKNOWN: &str = "@unknown";

/// Reads a message.
pub(crate) fn decode(message: &MessageDescriptor, bytes: &[u8]) -> Result<Value, Fault> {
    check::check(message, bytes)?;
    let decoded = DynamicMessage::decode(message.clone(), bytes).map_err(|error| Fault {
        path: String::new(),
        offset: bytes.len(),
        reason: error.to_string(),
    })?;
    Ok(to_value::to_value(&decoded, 0))
}

/// Reads a message from its JSON. Like every codec, it skips fields that the type does not have; [`UNKNOWN`] lists
/// their names.
pub(crate) fn from_json(message: &MessageDescriptor, json: &Value) -> Result<Value, Mismatch> {
    let mut unknown = Unknown::Collect(Vec::new());
    let mut value = to_value::to_value(&from_value(message, json, &mut unknown)?, 0);
    if let (Unknown::Collect(paths), Value::Map(entries)) = (unknown, &mut value)
        && !paths.is_empty()
    {
        entries.push((UNKNOWN.into(), Value::List(paths.into_iter().map(Value::Text).collect())));
    }
    Ok(value)
}
