//! Checks before a payload is decoded that it is a message of its type and stays within the limits.

use crate::limits::{Budget, MAX_DEPTH};
use prost::encoding::{WireType, decode_key, decode_varint};
use prost_reflect::{Kind, MessageDescriptor};

/// What is wrong with a payload, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Fault {
    /// The field: `pose.joints`.
    pub(crate) path: String,
    /// The number of bytes before the mistake.
    pub(crate) offset: usize,
    pub(crate) reason: String,
}

/// Checks that bytes are a message that can be decoded.
pub(crate) fn check(message: &MessageDescriptor, bytes: &[u8]) -> Result<(), Fault> {
    let mut rest = Rest { bytes, end: bytes.len() };
    fields(Some(message), &mut rest, None, 0, &Budget::new())
}

/// The bytes that were not read yet.
#[derive(Clone, Copy)]
struct Rest<'b> {
    bytes: &'b [u8],
    /// The offset of their end in the payload.
    end: usize,
}

impl<'b> Rest<'b> {
    fn offset(&self) -> usize {
        self.end - self.bytes.len()
    }

    fn fault(&self, reason: impl Into<String>) -> Fault {
        Fault { path: String::new(), offset: self.offset(), reason: reason.into() }
    }

    fn take(&mut self, length: usize) -> Result<Rest<'b>, Fault> {
        let left = self.bytes.len();
        let Some((taken, rest)) = self.bytes.split_at_checked(length) else {
            return Err(self.fault(format!("expected {length} bytes, found {left}")));
        };
        self.bytes = rest;
        Ok(Rest { bytes: taken, end: self.offset() })
    }

    fn varint(&mut self) -> Result<u64, Fault> {
        let start = *self;
        decode_varint(&mut self.bytes).map_err(|_| start.fault("a varint is truncated or too long"))
    }

    fn length_delimited(&mut self) -> Result<Rest<'b>, Fault> {
        let length = self.varint()?;
        self.take(usize::try_from(length).unwrap_or(usize::MAX))
    }
}

/// Checks the fields of a message, up to its end or to the end of its group. `message` is `None` in unknown groups.
fn fields(
    message: Option<&MessageDescriptor>,
    rest: &mut Rest<'_>,
    group: Option<u32>,
    depth: usize,
    budget: &Budget,
) -> Result<(), Fault> {
    if depth >= MAX_DEPTH {
        return Err(rest.fault(crate::limits::Exceeded::Depth.to_string()));
    }
    while !rest.bytes.is_empty() {
        let key = *rest;
        let (number, wire) = decode_key(&mut rest.bytes).map_err(|_| key.fault("expected the start of a field"))?;
        if wire == WireType::EndGroup {
            return if group == Some(number) { Ok(()) } else { Err(key.fault("unexpected end of a group")) };
        }
        let known = message.and_then(|message| {
            let field = message.get_field(number).map(|field| (field.name().to_owned(), field.kind(), field.is_list()));
            field.or_else(|| {
                let field = message.get_extension(number)?;
                Some((format!("[{}]", field.full_name()), field.kind(), field.is_list()))
            })
        });
        let field = Field { number, wire, known: known.as_ref().map(|(_, kind, is_list)| (kind, *is_list)) };
        one_field(&field, &key, rest, depth, budget).map_err(|fault| match &known {
            Some((name, ..)) if fault.path.is_empty() => Fault { path: name.clone(), ..fault },
            Some((name, ..)) => Fault { path: format!("{name}.{}", fault.path), ..fault },
            None => fault,
        })?;
    }
    if group.is_some() { Err(rest.fault("expected the end of a group")) } else { Ok(()) }
}

struct Field<'k> {
    number: u32,
    wire: WireType,
    /// Its kind, and whether it is repeated; `None` if the type does not have it.
    known: Option<(&'k Kind, bool)>,
}

fn one_field(
    field: &Field<'_>,
    key: &Rest<'_>,
    rest: &mut Rest<'_>,
    depth: usize,
    budget: &Budget,
) -> Result<(), Fault> {
    budget.take(1).map_err(|exceeded| key.fault(exceeded.to_string()))?;
    let Some((kind, is_list)) = field.known else {
        return skip(field, rest, depth, budget);
    };
    let expected = kind.wire_type();
    if field.wire == WireType::LengthDelimited && is_list && expected != WireType::LengthDelimited {
        return packed(expected, kind, rest, budget);
    }
    let is_group = field.wire == WireType::StartGroup && matches!(kind, Kind::Message(_));
    if field.wire != expected && !is_group {
        return Err(key.fault(format!("expected {}, found {}", word(expected), word(field.wire))));
    }
    match kind {
        Kind::Message(message) if is_group => fields(Some(message), rest, Some(field.number), depth + 1, budget),
        Kind::Message(message) => fields(Some(message), &mut rest.length_delimited()?, None, depth + 1, budget),
        Kind::String => {
            let text = rest.length_delimited()?;
            match std::str::from_utf8(text.bytes) {
                Ok(_) => Ok(()),
                Err(error) => Err(Fault {
                    offset: text.offset() + error.valid_up_to(),
                    ..text.fault("the text is not valid UTF-8")
                }),
            }
        }
        _ => skip(field, rest, depth, budget),
    }
}

/// Checks the numbers of a packed repeated field.
fn packed(wire: WireType, kind: &Kind, rest: &mut Rest<'_>, budget: &Budget) -> Result<(), Fault> {
    let mut numbers = rest.length_delimited()?;
    while !numbers.bytes.is_empty() {
        budget.take(1).map_err(|exceeded| numbers.fault(exceeded.to_string()))?;
        let number = Field { number: 0, wire, known: Some((kind, true)) };
        skip(&number, &mut numbers, 0, budget)?;
    }
    Ok(())
}

fn skip(field: &Field<'_>, rest: &mut Rest<'_>, depth: usize, budget: &Budget) -> Result<(), Fault> {
    match field.wire {
        WireType::Varint => rest.varint().map(drop),
        WireType::SixtyFourBit => rest.take(8).map(drop),
        WireType::ThirtyTwoBit => rest.take(4).map(drop),
        WireType::LengthDelimited => rest.length_delimited().map(drop),
        WireType::StartGroup => fields(None, rest, Some(field.number), depth + 1, budget),
        WireType::EndGroup => Err(rest.fault("unexpected end of a group")),
    }
}

fn word(wire: WireType) -> &'static str {
    match wire {
        WireType::Varint => "a varint",
        WireType::SixtyFourBit => "an 8-byte number",
        WireType::LengthDelimited => "a length and bytes",
        WireType::StartGroup => "the start of a group",
        WireType::EndGroup => "the end of a group",
        WireType::ThirtyTwoBit => "a 4-byte number",
    }
}
