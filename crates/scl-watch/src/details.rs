//! The messages of one gate: the last one decoded, the numbers of one field, and the pairs of requests and replies.

use scl::tap::{Observation, ObservedKind, TapEvent};
use scl_observe::{ObservedGate, System, Taps, TapsEvent};
use scl_value::{FieldPath, MessageType, Value, to_yaml};
use serde_json::{Value as Json, json};
use std::collections::VecDeque;
use std::time::Duration;
use tokio::time::{Instant, sleep_until};

/// The time between two values that the page gets.
const PERIOD: Duration = Duration::from_millis(250);
/// The time between two attempts to find a gate that is not there.
const RETRY: Duration = Duration::from_secs(1);
/// Maximum number of points of a plot in one period: more than a screen has in a quarter of a second.
const MOST_POINTS: usize = 200;
/// Longest text of a message, in bytes of UTF-8.
const LONGEST_TEXT: usize = 20_000;
/// Messages longer than this, in bytes, are not decoded: it would take longer than a period.
const LONGEST_DECODED: usize = 4 << 20;
/// Maximum number of calls that are shown.
const MOST_CALLS: usize = 20;
/// Maximum number of fields that can be chosen for a plot.
const MOST_FIELDS: usize = 300;

/// What is shown of a gate.
pub(crate) struct Details {
    system: System,
    gate: String,
    /// The field that is plotted.
    field: Option<FieldPath>,
    open: Option<Open>,
    next: Instant,
}

/// A gate that runs.
struct Open {
    taps: Taps,
    message: MessageType,
    reply: MessageType,
    last: Option<Observation>,
    seen: u64,
    points: Vec<(f64, f64)>,
    calls: VecDeque<Observation>,
}

impl Details {
    pub(crate) fn new(system: System, gate: String, field: Option<FieldPath>) -> Self {
        Self { system, gate, field, open: None, next: Instant::now() }
    }

    /// Waits until there is something new to show, and returns that.
    ///
    /// # Cancel safety
    /// Cancel safe: what has arrived is shown by the next call.
    pub(crate) async fn next(&mut self) -> Json {
        loop {
            let Some(open) = &mut self.open else {
                sleep_until(self.next).await;
                self.next = Instant::now() + RETRY;
                match self.system.gate(&self.gate) {
                    Ok(gate) => self.open = Some(Open::new(&self.system, gate)),
                    Err(problem) => return json!({"gate": self.gate, "error": problem.message()}),
                }
                continue;
            };
            tokio::select! {
                event = open.taps.next() => match event {
                    TapsEvent::Event { event: TapEvent::Observed(seen), .. } => open.learn(seen, self.field.as_ref()),
                    TapsEvent::Event { event: TapEvent::Disconnected, .. } => self.open = None,
                    TapsEvent::Event { event: TapEvent::Connected, .. } | TapsEvent::Started(_) => {}
                },
                () = sleep_until(self.next) => {
                    self.next = Instant::now() + PERIOD;
                    if let Some(shown) = open.take(&self.gate) {
                        return shown;
                    }
                }
            }
        }
    }
}

impl Open {
    fn new(system: &System, gate: ObservedGate) -> Self {
        let (message, reply) = MessageType::of_gate(gate.payload.types(), &gate.codec, gate.schema.as_deref());
        let taps = Taps::open(system, vec![gate]);
        Self { taps, message, reply, last: None, seen: 0, points: Vec::new(), calls: VecDeque::new() }
    }

    fn learn(&mut self, seen: Observation, field: Option<&FieldPath>) {
        self.seen += 1;
        if let Some(field) = field
            && self.points.len() < MOST_POINTS
            && let Some(number) = field.find(&self.decode(&seen)).and_then(Value::as_number)
        {
            self.points.push((milliseconds(&seen), number));
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
    fn take(&mut self, gate: &str) -> Option<Json> {
        let last = self.last.take()?;
        let value = self.decode(&last);
        let numbers = FieldPath::leaves(&value)
            .into_iter()
            .filter(|path| path.find(&value).is_some_and(|value| value.as_number().is_some()));
        let fields: Vec<String> = numbers.take(MOST_FIELDS).map(|path| path.to_string()).collect();
        let call = |seen: &Observation| {
            json!({"time": milliseconds(seen), "kind": word(seen.kind), "call": seen.call_id,
                   "text": text_of(&self.decode(seen))})
        };
        let calls: Vec<Json> = self.calls.iter().map(call).collect();
        let points = std::mem::take(&mut self.points);
        Some(json!({
            "gate": gate, "time": milliseconds(&last), "sequence": last.sequence, "bytes": last.payload.len(),
            "seen": self.seen, "text": text_of(&value), "fields": fields, "points": points, "calls": calls,
        }))
    }

    fn decode(&self, seen: &Observation) -> Value {
        let messages = if seen.kind == ObservedKind::Reply { &self.reply } else { &self.message };
        if seen.payload.len() > LONGEST_DECODED {
            return MessageType::opaque("it is too long to be decoded here").show(&seen.payload);
        }
        messages.show(&seen.payload)
    }
}

/// When a message was sent, in milliseconds since 1970.
fn milliseconds(seen: &Observation) -> f64 {
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
