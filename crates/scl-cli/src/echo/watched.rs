//! One gate of `scl echo`: how its messages are decoded, and which of them were lost.

use scl::tap::{Observation, ObservedKind};
use scl_observe::{ObservedGate, System};
use scl_plan::Payload;
use scl_terminal::print_err;
use scl_value::{Condition, FieldPath, GateTypes, MessageType, Mismatch, Value};
use std::time::{Duration, Instant};

/// Losses within this time are noted together: at a thousand messages a second, writing a note for each would cause the
/// next loss.
const BETWEEN_NOTES: Duration = Duration::from_secs(1);

/// A gate that is observed at its own tap.
pub(super) struct Watched {
    gate: ObservedGate,
    pub(super) name: String,
    types: GateTypes,
    /// The sequence number of the next message if none is lost; `None` right after connecting.
    next: Option<u64>,
    was_connected: bool,
    /// Number of messages that were not seen.
    pub(super) lost: u64,
    /// How many of them were not noted yet.
    unnoted: u64,
    noted: Option<Instant>,
}

impl Watched {
    pub(super) fn new(gate: ObservedGate) -> Self {
        let types = types_of(&gate);
        let name = gate.name();
        Self { gate, name, types, next: None, was_connected: false, lost: 0, unnoted: 0, noted: None }
    }

    /// Whether it has requests and replies.
    pub(super) fn exchanges(&self) -> bool {
        matches!(self.gate.payload, Payload::Exchange { .. })
    }

    /// The types of its messages, or of its requests and replies.
    pub(super) fn types(&self) -> impl Iterator<Item = &MessageType> {
        std::iter::once(&self.types.message).chain(self.exchanges().then_some(&self.types.reply))
    }

    pub(super) fn check_field(&self, path: &FieldPath) -> Result<(), Mismatch> {
        self.check(|messages| messages.check_field(path))
    }

    pub(super) fn check_condition(&self, condition: &Condition) -> Result<(), Mismatch> {
        self.check(|messages| condition.check(messages))
    }

    /// Returns the first error if `check` fails for all of the gate's types.
    fn check(&self, check: impl Fn(&MessageType) -> Result<(), Mismatch>) -> Result<(), Mismatch> {
        check(&self.types.message).or_else(|error| match self.exchanges() {
            true => check(&self.types.reply).map_err(|_| error),
            false => Err(error),
        })
    }

    /// Handles a new connection. After a reconnect, the types are read again, because the component may have been
    /// rebuilt.
    pub(super) fn connected(&mut self, system: &System) {
        if self.was_connected {
            if let Ok(gate) = system.gate(&self.name) {
                self.types = types_of(&gate);
                self.gate = gate;
            }
            print_err(&format!("note: `{}` is connected again\n", self.name));
        }
        (self.was_connected, self.next) = (true, None);
    }

    pub(super) fn disconnected(&mut self) {
        self.note_lost();
        print_err(&format!("note: `{}` has disconnected; waiting until it runs again\n", self.name));
    }

    /// Counts the messages that were lost before this one, and notes them unless the last note is too recent.
    pub(super) fn count(&mut self, seen: &Observation) {
        let lost = self.next.map_or(0, |next| seen.sequence.saturating_sub(next));
        self.next = Some(seen.sequence.saturating_add(1));
        self.lost += lost;
        self.unnoted += lost;
        if self.unnoted > 0 && self.noted.is_none_or(|noted| noted.elapsed() >= BETWEEN_NOTES) {
            self.note_lost();
        }
    }

    /// Prints a note about the losses that have not been noted yet.
    pub(super) fn note_lost(&mut self) {
        if self.unnoted > 0 {
            print_err(&format!("note: lost {} messages of `{}`: read too slowly\n", self.unnoted, self.name));
            (self.unnoted, self.noted) = (0, Some(Instant::now()));
        }
    }

    /// The message, or its bytes and why they cannot be decoded.
    pub(super) fn decode(&self, seen: &Observation) -> Value {
        self.type_of(seen).show(&seen.payload)
    }

    /// A message or a part of it as it is printed in JSON.
    pub(super) fn for_json(&self, seen: &Observation, shown: Value) -> Value {
        self.type_of(seen).for_json(shown)
    }

    fn type_of(&self, seen: &Observation) -> &MessageType {
        self.types.of(seen.kind == ObservedKind::Reply)
    }
}

/// Returns the types of a gate's messages or requests, and of its replies.
fn types_of(gate: &ObservedGate) -> GateTypes {
    GateTypes::new(gate.payload.types(), &gate.codec, gate.schema.as_deref())
}
