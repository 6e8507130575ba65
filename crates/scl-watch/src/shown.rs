//! The messages of one gate, as the page shows them: the last one decoded, the numbers of one field, and the pairs of
//! requests and replies.

use scl::bytes::Bytes;
use scl::tap::{Observation, ObservedKind};
use scl_value::{FieldPath, MessageType, Value, to_yaml};
use serde_json::{Value as Json, json};
use std::collections::VecDeque;

/// Maximum number of points of a plot at a time; of more numbers, every other is left out.
const MOST_POINTS: usize = 400;
/// Longest text of a message, in bytes of UTF-8.
const LONGEST_TEXT: usize = 20_000;
/// Messages longer than this, in bytes, are not decoded: it would take longer than a period.
const LONGEST_DECODED: usize = 4 << 20;
/// Maximum number of calls that are shown.
const MOST_CALLS: usize = 20;
/// Maximum number of fields that can be chosen for a plot.
const MOST_FIELDS: usize = 300;

/// A message of a running system, or of a recording.
#[derive(Debug, Clone)]
pub(crate) struct Message {
    pub(crate) kind: ObservedKind,
    pub(crate) sequence: u64,
    pub(crate) call: u64,
    pub(crate) sent_ns: u64,
    pub(crate) payload: Bytes,
}

/// The messages of a gate.
pub(crate) struct Shown {
    gate: String,
    message: MessageType,
    reply: MessageType,
    /// The field that is plotted.
    field: Option<FieldPath>,
    last: Option<Message>,
    seen: u64,
    points: Vec<(f64, f64)>,
    /// Of so many numbers, one becomes a point.
    thinned: u64,
    calls: VecDeque<Message>,
}

impl From<Observation> for Message {
    fn from(seen: Observation) -> Self {
        let Observation { kind, sequence, call_id, sent_ns, payload, .. } = seen;
        Self { kind, sequence, call: call_id, sent_ns, payload }
    }
}

impl Shown {
    /// Shows messages of these types, the latter for replies.
    pub(crate) fn new(gate: String, (message, reply): (MessageType, MessageType), field: Option<FieldPath>) -> Self {
        Self {
            gate,
            message,
            reply,
            field,
            last: None,
            seen: 0,
            points: Vec::new(),
            thinned: 1,
            calls: VecDeque::new(),
        }
    }

    /// Whether there is nothing to show.
    pub(crate) fn is_empty(&self) -> bool {
        self.last.is_none()
    }

    pub(crate) fn learn(&mut self, seen: Message) {
        self.seen += 1;
        if let Some(field) = &self.field
            && self.seen.is_multiple_of(self.thinned)
            && let Some(number) = field.find(&self.decode(&seen)).and_then(Value::as_number)
        {
            self.points.push((milliseconds(&seen), number));
            if self.points.len() > MOST_POINTS {
                let mut index = 0;
                self.points.retain(|_| {
                    index += 1;
                    index % 2 == 1
                });
                self.thinned *= 2;
            }
        }
        if seen.kind != ObservedKind::Message {
            self.calls.push_back(seen.clone());
            if self.calls.len() > MOST_CALLS {
                self.calls.pop_front();
            }
        }
        self.last = Some(seen);
    }

    /// Returns what has come since the last call; `None` if nothing has.
    pub(crate) fn take(&mut self) -> Option<Json> {
        let last = self.last.take()?;
        let value = self.decode(&last);
        let numbers = FieldPath::leaves(&value)
            .into_iter()
            .filter(|path| path.find(&value).is_some_and(|value| value.as_number().is_some()));
        let fields: Vec<String> = numbers.take(MOST_FIELDS).map(|path| path.to_string()).collect();
        let call = |seen: &Message| {
            json!({"time": milliseconds(seen), "kind": word(seen.kind), "call": seen.call,
                   "text": text_of(&self.decode(seen))})
        };
        let calls: Vec<Json> = self.calls.iter().map(call).collect();
        let points = std::mem::take(&mut self.points);
        self.thinned = 1;
        Some(json!({
            "gate": self.gate, "time": milliseconds(&last), "sequence": last.sequence, "bytes": last.payload.len(),
            "seen": self.seen, "text": text_of(&value), "fields": fields, "points": points, "calls": calls,
        }))
    }

    fn decode(&self, seen: &Message) -> Value {
        let messages = if seen.kind == ObservedKind::Reply { &self.reply } else { &self.message };
        if seen.payload.len() > LONGEST_DECODED {
            return MessageType::opaque("it is too long to be decoded here").show(&seen.payload);
        }
        messages.show(&seen.payload)
    }
}

/// When a message was sent, in milliseconds since 1970.
fn milliseconds(seen: &Message) -> f64 {
    seen.sent_ns as f64 / 1e6
}

fn word(kind: ObservedKind) -> &'static str {
    match kind {
        ObservedKind::Message => "message",
        ObservedKind::Request => "request",
        ObservedKind::Reply => "reply",
    }
}

/// A message as YAML, or its beginning.
fn text_of(value: &Value) -> String {
    let mut text = to_yaml(value);
    if text.len() > LONGEST_TEXT {
        let end = (0..=LONGEST_TEXT).rev().find(|&end| text.is_char_boundary(end)).unwrap_or(0);
        text.truncate(end);
        text.push_str("\n…");
    }
    text
}
