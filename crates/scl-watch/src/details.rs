//! The messages of one gate of a running system, observed at its tap.

use crate::shown::Shown;
use scl::tap::TapEvent;
use scl_observe::{ObservedGate, System, Taps, TapsEvent};
use scl_value::{FieldPath, GateTypes};
use serde_json::{Value as Json, json};
use std::time::Duration;
use tokio::time::{Instant, sleep_until};

/// The time between two values that the page gets.
const PERIOD: Duration = Duration::from_millis(250);
/// The time between two attempts to find a gate that is not there.
const RETRY: Duration = Duration::from_secs(1);

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
    shown: Shown,
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
                    Ok(gate) => self.open = Some(Open::new(&self.system, gate, self.gate.clone(), self.field.clone())),
                    Err(problem) => return json!({"gate": self.gate, "error": problem.message()}),
                }
                continue;
            };
            tokio::select! {
                event = open.taps.next() => match event {
                    TapsEvent::Event { event: TapEvent::Observed(seen), .. } => open.shown.learn(seen.into()),
                    TapsEvent::Event { event: TapEvent::Disconnected, .. } => self.open = None,
                    TapsEvent::Event { event: TapEvent::Connected, .. } | TapsEvent::Started(_) => {}
                },
                () = sleep_until(self.next) => {
                    self.next = Instant::now() + PERIOD;
                    if let Some(shown) = open.shown.take() {
                        return shown;
                    }
                }
            }
        }
    }
}

impl Open {
    /// `name` is the gate that the page asks for, which may be a peer of the observed one.
    fn new(system: &System, gate: ObservedGate, name: String, field: Option<FieldPath>) -> Self {
        let types = GateTypes::new(gate.payload.types(), &gate.codec, gate.schema.as_deref());
        let shown = Shown::new(name, types, field);
        Self { taps: Taps::open(system, vec![gate]), shown }
    }
}
