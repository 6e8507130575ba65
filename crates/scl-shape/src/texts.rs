//! Whether the texts of a message are UTF-8.
//!
//! Libraries of C and C++ write a `string` with any bytes, and receivers in Rust, Python and Go refuse the whole
//! message.

use crate::declared;
use crate::wire::{GROUP_END, GROUP_START, LENGTH_DELIMITED, LEVELS, content_length, key};
use prost_types::FileDescriptorSet;
use prost_types::field_descriptor_proto::Type;
use std::collections::HashMap;

/// Checks the texts of messages of one type.
#[derive(Debug, Clone)]
pub struct TextCheck {
    /// For the type itself, then for each type that it contains: the fields that are or contain texts, by number.
    messages: Vec<HashMap<u32, Field>>,
}

#[derive(Debug, Clone)]
struct Field {
    name: String,
    /// The index of the message type; `None` for a text.
    message: Option<usize>,
}

/// A message or a group that is being walked through.
struct Open<'m> {
    fields: Option<&'m HashMap<u32, Field>>,
    name: &'m str,
    end: usize,
}

impl TextCheck {
    /// A check for messages of this full name. `None` if they have no texts, or the files do not declare all types.
    pub fn new(files: &FileDescriptorSet, name: &str) -> Option<Self> {
        let types = declared::reachable(files, name)?;
        let index: HashMap<&str, usize> = types.iter().enumerate().map(|(index, (name, _))| (*name, index)).collect();
        let mut messages: Vec<HashMap<u32, Field>> = vec![HashMap::new(); types.len()];
        // A message contains texts if a field is a text or a message that contains texts. Repeat until no more are
        // found.
        loop {
            let mut found = false;
            for (at, (_, message)) in types.iter().enumerate() {
                for field in &message.field {
                    let inner = declared::is_message(field).then(|| index[declared::type_name(field)]);
                    let number = field.number().unsigned_abs();
                    let has_texts = inner.map_or(field.r#type() == Type::String, |inner| !messages[inner].is_empty());
                    if has_texts && !messages[at].contains_key(&number) {
                        messages[at].insert(number, Field { name: field.name().to_owned(), message: inner });
                        found = true;
                    }
                }
            }
            if !found {
                return (!messages[0].is_empty()).then_some(Self { messages });
            }
        }
    }

    /// Looks for a text that is not UTF-8. Of a damaged frame, the part before the damage is checked.
    ///
    /// # Errors
    /// Returns the path of the field with that text: `pose.frame`.
    pub fn check(&self, frame: &[u8]) -> Result<(), String> {
        let mut at = 0;
        let mut open = vec![Open { fields: self.messages.first(), name: "", end: frame.len() }];
        while let Some(current) = open.last() {
            let (fields, end) = (current.fields, current.end);
            if at >= end {
                open.pop();
                continue;
            }
            let Some((number, wire_type)) = key(&frame[..end], &mut at) else { return Ok(()) };
            if wire_type == GROUP_END {
                open.pop();
                continue;
            }
            let Some(length) = content_length(wire_type, &frame[..end], &mut at) else { return Ok(()) };
            let field = fields.and_then(|fields| fields.get(&number));
            let inner = field.and_then(|field| Some((&self.messages[field.message?], field.name.as_str())));
            let is_group = wire_type == GROUP_START;
            if is_group || wire_type == LENGTH_DELIMITED && inner.is_some() {
                if open.len() == LEVELS {
                    return Ok(());
                }
                let (fields, name) = inner.unzip();
                let end = if is_group { end } else { at + length };
                open.push(Open { fields, name: name.unwrap_or_default(), end });
                continue;
            }
            if let Some(field) = field.filter(|field| field.message.is_none() && wire_type == LENGTH_DELIMITED)
                && std::str::from_utf8(&frame[at..at + length]).is_err()
            {
                let names = open.iter().skip(1).map(|open| open.name).chain([field.name.as_str()]);
                return Err(names.collect::<Vec<_>>().join("."));
            }
            at += length;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use prost_types::field_descriptor_proto::Label;
    use prost_types::{DescriptorProto, FieldDescriptorProto, FileDescriptorProto};

    fn field(number: i32, name: &str, kind: Type, message: &str) -> FieldDescriptorProto {
        FieldDescriptorProto {
            number: Some(number),
            name: Some(name.to_owned()),
            r#type: Some(kind.into()),
            label: Some(Label::Optional.into()),
            type_name: (!message.is_empty()).then(|| format!(".rover.{message}")),
            ..FieldDescriptorProto::default()
        }
    }

    fn message(name: &str, field: Vec<FieldDescriptorProto>) -> DescriptorProto {
        DescriptorProto { name: Some(name.to_owned()), field, ..DescriptorProto::default() }
    }

    fn files() -> FileDescriptorSet {
        let messages = vec![
            message("Numbers", vec![field(1, "x", Type::Double, ""), field(2, "raw", Type::Bytes, "")]),
            message(
                "Event",
                vec![
                    field(1, "text", Type::String, ""),
                    field(2, "inner", Type::Message, "Event"),
                    field(3, "numbers", Type::Message, "Numbers"),
                    field(4, "names", Type::Message, "Entry"),
                    field(5, "group", Type::Group, "Event"),
                    field(6, "raw", Type::Bytes, ""),
                ],
            ),
            message("Entry", vec![field(1, "key", Type::String, ""), field(2, "value", Type::Int32, "")]),
        ];
        let file =
            FileDescriptorProto { package: Some("rover".to_owned()), message_type: messages, ..Default::default() };
        FileDescriptorSet { file: vec![file] }
    }

    #[test]
    fn texts_that_are_not_utf_8_are_named() {
        let check = TextCheck::new(&files(), "rover.Event").unwrap();
        let cases: [(&[u8], &str); 13] = [
            (b"", ""),
            (b"\x0a\x02\xc3\xa4", ""),
            (b"\x0a\x01\xff", "text"),
            (b"\x0a\x01a\x0a\x01\xc3", "text"),
            (b"\x12\x03\x0a\x01\xff", "inner.text"),
            (b"\x12\x05\x12\x03\x0a\x01\xff", "inner.inner.text"),
            (b"\x22\x03\x0a\x01\xff", "names.key"),
            (b"\x2b\x0a\x01\xff\x2c", "group.text"),
            // After a message, a group and fields that are skipped.
            (b"\x12\x03\x0a\x01a\x2b\x0a\x01a\x2c\x08\x05\x11\0\0\0\0\0\0\0\0\x0a\x01\xff", "text"),
            // Bytes, also in a message without texts, and fields that the type does not have.
            (b"\x32\x01\xff\x1a\x03\x12\x01\xff\x7a\x01\xff\x7b\x0a\x01\xff\x7c", ""),
            (b"\x0a\x05\xff", ""),
            (b"\x12\x7f\x0a\x01\xff", ""),
            (b"\x0c\x0c\x0c", ""),
        ];
        for (frame, expected) in cases {
            let expected = if expected.is_empty() { Ok(()) } else { Err(expected.to_owned()) };
            assert_eq!(check.check(frame), expected, "{frame:x?}");
        }
    }

    #[test]
    fn types_without_texts_are_not_checked() {
        assert!(TextCheck::new(&files(), "rover.Numbers").is_none());
        assert!(TextCheck::new(&files(), "rover.Unknown").is_none());
    }

    #[test]
    fn nesting_has_an_end() {
        let check = TextCheck::new(&files(), "rover.Event").unwrap();
        assert_eq!(check.check(&b"\x2b".repeat(100_000)), Ok(()));
    }
}
