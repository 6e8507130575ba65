//! The messages of one gate, as the page shows them: the last one decoded, the numbers of one field, and the pairs of
//! requests and replies.

use scl::bytes::Bytes;
use scl::tap::{Observation, ObservedKind};
use scl_value::{FieldPath, GateTypes, MessageType, Value, to_yaml};
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
    types: GateTypes,
    /// The field that is plotted.
    field: Option<FieldPath>,
    last: Option<Message>,
    seen: u64,
    points: Vec<(f64, f64)>,
    /// One number in this many becomes a point.
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
    /// Shows messages of these types.
    pub(crate) fn new(gate: String, types: GateTypes, field: Option<FieldPath>) -> Self {
        Self { gate, types, field, last: None, seen: 0, points: Vec::new(), thinned: 1, calls: VecDeque::new() }
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
        if seen.payload.len() > LONGEST_DECODED {
            return MessageType::opaque("it is too long to be decoded here").show(&seen.payload);
        }
        self.types.of(seen.kind == ObservedKind::Reply).show(&seen.payload)
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

#[cfg(test)]
mod tests {
    use super::{LONGEST_TEXT, MOST_POINTS, Message, Shown};
    use scl::bytes::Bytes;
    use scl::tap::ObservedKind;
    use scl_value::{GateTypes, MessageType};

    fn shown(field: Option<&str>) -> Shown {
        let json = || MessageType::new(Some("x.Y"), "json", None).unwrap();
        Shown::new(
            "a.b".to_owned(),
            GateTypes { message: json(), reply: json() },
            field.map(|field| field.parse().unwrap()),
        )
    }

    fn message(number: u64, payload: impl Into<Bytes>) -> Message {
        let (kind, sent_ns) = (ObservedKind::Message, number * 1_000_000);
        Message { kind, sequence: number, call: 0, sent_ns, payload: payload.into() }
    }

    #[test]
    fn of_a_long_message_the_beginning_is_shown_and_of_a_huge_one_its_length() {
        let mut shown = shown(None);
        let text_of = |shown: &mut Shown, payload: String| {
            shown.learn(message(0, payload));
            shown.take().unwrap()["text"].as_str().unwrap().to_owned()
        };
        let text = text_of(&mut shown, format!("[{}1]", "1, ".repeat(1 << 20)));
        assert!(text.len() < LONGEST_TEXT + 10 && text.ends_with("\n…"), "{}", text.len());
        let text = text_of(&mut shown, format!("[{}1]", "1,".repeat(32 << 20)));
        assert!(text.len() < LONGEST_TEXT && text.contains("too long to be decoded"), "{text}");
    }

    #[test]
    fn many_numbers_are_thinned_out_evenly() {
        let mut shown = shown(Some("n"));
        for number in 0..10_000 {
            shown.learn(message(number, format!("{{\"n\": {number}}}")));
        }
        let value = shown.take().unwrap();
        let times: Vec<f64> = value["points"].as_array().unwrap().iter().map(|it| it[0].as_f64().unwrap()).collect();
        assert!((MOST_POINTS / 2..=MOST_POINTS).contains(&times.len()), "{}", times.len());
        assert!(times[0] < 100.0 && times[times.len() - 1] > 9_900.0);
        let distances: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let (shortest, longest) =
            (distances.iter().copied().fold(f64::MAX, f64::min), distances.iter().copied().fold(0.0, f64::max));
        assert!(longest < 3.0 * shortest, "{shortest} {longest}");
    }
}
