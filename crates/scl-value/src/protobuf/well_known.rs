//! Protobuf's own messages in the short form that they have in its JSON: `google.protobuf.Timestamp` as a text.

use prost_reflect::MessageDescriptor;

/// The key of the type of an `Any`.
pub(super) const TYPE: &str = "@type";

/// What the short form of a well-known message looks like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Short {
    /// A text, as in JSON.
    Text,
    /// The value that it wraps.
    Wrapper,
    /// A map of anything.
    Struct,
    /// Anything.
    Value,
    /// A list of anything.
    List,
    /// The fields of the message inside, with its type.
    Any,
}

/// The short form of a message; `None` if it has none.
pub(super) fn short(message: &MessageDescriptor) -> Option<Short> {
    Some(match message.full_name().strip_prefix("google.protobuf.")? {
        "Timestamp" | "Duration" | "FieldMask" => Short::Text,
        "DoubleValue" | "FloatValue" | "Int64Value" | "UInt64Value" | "Int32Value" | "UInt32Value" | "BoolValue"
        | "StringValue" | "BytesValue" => Short::Wrapper,
        "Struct" => Short::Struct,
        "Value" => Short::Value,
        "ListValue" => Short::List,
        "Any" => Short::Any,
        _ => return None,
    })
}

/// The message with the type of an `Any`, if the schema describes it.
pub(super) fn any_type(any: &MessageDescriptor, url: &str) -> Option<MessageDescriptor> {
    any.parent_pool().get_message_by_name(url.rsplit('/').next()?)
}
