//! Walks through a frame of protobuf.

use super::{Cost, Kind, Language, MessageLayout};
use crate::wire::{GROUP_END, GROUP_START, LENGTH_DELIMITED, LEVELS, content_length, key};

/// What a kept unknown field takes besides its content.
const UNKNOWN: u64 = 104;
/// What the block of a text's content takes besides the content.
const BLOCK: u64 = 32;

/// A message that is being walked through.
struct Open<'m> {
    message: Option<&'m MessageLayout>,
    end: usize,
    /// The field that was seen last.
    last: u32,
}

pub(super) fn most_per_byte(messages: &[MessageLayout], language: Language) -> u64 {
    let unknown = if language == Language::Rust { 0 } else { UNKNOWN + BLOCK };
    let fields = messages.iter().flat_map(|message| &message.fields);
    let most = fields.map(|field| match field.kind {
        // `4 * width` is for packed numbers of one byte each.
        Kind::Number { width, .. } => field.cost.first.max(4 * width),
        _ => field.cost.first.saturating_add(BLOCK),
    });
    most.fold(unknown, u64::max) / 2 + 1
}

/// Returns the memory that a decoded frame takes; for a damaged frame, what the part before the damage takes.
pub(super) fn estimate(messages: &[MessageLayout], language: Language, frame: &[u8]) -> u64 {
    let mut total = messages[0].size;
    let mut at = 0;
    let mut open = vec![Open { message: Some(&messages[0]), end: frame.len(), last: 0 }];
    while let Some(current) = open.last_mut() {
        let (message, end) = (current.message, current.end);
        if at >= end {
            open.pop();
            continue;
        }
        let Some((number, wire_type)) = key(&frame[..end], &mut at) else { return total };
        if wire_type == GROUP_END {
            open.pop();
            continue;
        }
        let Some(length) = content_length(wire_type, &frame[..end], &mut at) else { return total };
        let field = message.and_then(|message| message.field(number));
        let is_next = std::mem::replace(&mut current.last, number) == number;
        let of = |cost: Cost| if is_next { cost.next } else { cost.first };
        let content = if length == 0 { 0 } else { length as u64 + BLOCK };
        let (cost, inner) = match field.map(|field| (field.kind, field.cost)) {
            Some((Kind::Message(inner) | Kind::Map(inner), cost))
                if matches!(wire_type, LENGTH_DELIMITED | GROUP_START) =>
            {
                (of(cost), Some(&messages[inner]))
            }
            Some((Kind::Text, cost)) => (of(cost).saturating_add(content), None),
            Some((Kind::Number { width, packed }, cost)) if wire_type == LENGTH_DELIMITED => {
                let numbers = numbers(&frame[at..at + length], packed);
                (of(cost).saturating_add(2 * width * numbers), None)
            }
            Some((Kind::Number { .. }, cost)) => (of(cost), None),
            _ if language == Language::Rust => (0, None),
            _ => (UNKNOWN + content, None),
        };
        total = total.saturating_add(cost);
        if let Some(inner) = inner.map(Some).or((wire_type == GROUP_START).then_some(None)) {
            if open.len() == LEVELS {
                return total;
            }
            let end = if wire_type == GROUP_START { end } else { at + length };
            open.push(Open { message: inner, end, last: 0 });
        } else {
            at += length;
        }
    }
    total
}

/// How many numbers a packed field contains.
fn numbers(content: &[u8], packed: usize) -> u64 {
    let numbers = match packed {
        0 => content.iter().filter(|byte| **byte < 0x80).count(),
        width => content.len() / width,
    };
    numbers as u64
}
