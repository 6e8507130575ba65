//! What a scenario expects, and whether a simulation has met it.

use scl_plan::{GatePlan, Payload, SystemPlan};
use scl_record::recording::Recording;
use scl_terminal::Problem;
use scl_text::duration;
use scl_text::gate_name::split;
use scl_value::{Condition, MessageType, Value, to_json};
use std::time::Duration;

/// Something that must hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Expectation {
    /// Where the scenario says so: `rough_day.yaml:9:5`.
    pub place: String,
    /// What.
    pub expected: Expected,
}

/// What must hold.
#[derive(Debug, Clone, PartialEq)]
pub enum Expected {
    /// Each message of a gate meets a condition.
    Always {
        /// The gate, as `component.gate`.
        gate: String,
        /// The condition.
        condition: Condition,
    },
    /// A message of a gate meets a condition.
    Eventually {
        /// The gate, as `component.gate`.
        gate: String,
        /// The condition.
        condition: Condition,
        /// When at the latest.
        by: Option<Duration>,
    },
    /// A component's program ends with an exit code.
    Exit {
        /// The component.
        component: String,
        /// The code.
        code: u8,
    },
}

/// An expectation that was not met.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Failure {
    /// When that was clear, if it is known.
    pub at: Option<Duration>,
    /// What was expected, and what happened.
    pub problem: Problem,
}

/// The type of a gate's messages; `None` for requests and replies.
pub(super) fn messages_of(gate: &GatePlan) -> Option<Option<&str>> {
    match &gate.payload {
        Payload::Bytes => Some(None),
        Payload::Message(name) => Some(Some(name)),
        Payload::Exchange { .. } => None,
    }
}

/// Checks that the messages of a gate have the fields of a condition.
pub(super) fn check(condition: &Condition, system: &SystemPlan, gate: &str) -> Result<(), Problem> {
    let found = split(gate).and_then(|(component, name)| {
        let plan = system.component(component).ok()?;
        let gate = plan.gate(name)?;
        let descriptors = plan.schema.as_ref().map(|schema| &*schema.descriptors);
        MessageType::new(messages_of(gate)?, &gate.codec, descriptors).ok()
    });
    match found {
        Some(messages) => condition.check(&messages).map_err(Problem::from),
        None => Ok(()),
    }
}

/// Returns the expectations that a simulation has not met. `exit` is the exit code of a component's last process, if it
/// has ended by itself; `start` is what the wall clock has shown at the start.
///
/// # Errors
/// The recording cannot be read.
pub fn unmet(
    expectations: &[Expectation],
    recording: &Recording,
    exit: &dyn Fn(&str) -> Option<i32>,
    start: Duration,
) -> Result<Vec<Failure>, Problem> {
    let mut open: Vec<Open<'_>> = expectations.iter().map(Open::new).collect();
    let mut messages = recording.messages();
    while let Some(message) = messages.read()? {
        let channel = &messages.channels()[message.channel];
        let gate = channel.topic.gate_name();
        if !open.iter().any(|it| it.wants(&gate)) {
            continue;
        }
        let at = Duration::from_nanos(message.sent_ns).saturating_sub(start);
        let value = channel.message_type().show(&message.payload);
        open.iter_mut().filter(|it| it.wants(&gate)).for_each(|it| it.see(at, &value));
    }
    Ok(open.into_iter().filter_map(|it| it.finish(exit)).collect())
}

/// An expectation while messages are read.
struct Open<'e> {
    expectation: &'e Expectation,
    seen: u64,
    /// The last message with its time.
    last: Option<(Duration, String)>,
    met: bool,
    failure: Option<Failure>,
}

impl<'e> Open<'e> {
    fn new(expectation: &'e Expectation) -> Self {
        Self { expectation, seen: 0, last: None, met: false, failure: None }
    }

    fn wants(&self, seen: &str) -> bool {
        let is_open = !self.met && self.failure.is_none();
        match &self.expectation.expected {
            Expected::Always { gate, .. } | Expected::Eventually { gate, .. } => is_open && gate == seen,
            Expected::Exit { .. } => false,
        }
    }

    fn see(&mut self, at: Duration, value: &Value) {
        self.seen += 1;
        match &self.expectation.expected {
            Expected::Always { gate, condition } => {
                if !condition.holds(value).unwrap_or(false) {
                    let text = format!("`{gate}` does not always meet its condition");
                    let note = format!("at {:.6} s, it was {}", at.as_secs_f64(), to_json(value));
                    self.failure = Some(self.failed(Some(at), text, note));
                }
            }
            Expected::Eventually { condition, by, .. } => {
                if by.is_none_or(|by| at <= by) {
                    self.met = condition.holds(value).unwrap_or(false);
                    self.last = Some((at, to_json(value)));
                }
            }
            Expected::Exit { .. } => {}
        }
    }

    fn failed(&self, at: Option<Duration>, text: String, note: String) -> Failure {
        Failure { at, problem: Problem::new(text).at(self.expectation.place.clone()).note(note) }
    }

    fn finish(self, exit: &dyn Fn(&str) -> Option<i32>) -> Option<Failure> {
        match &self.expectation.expected {
            Expected::Always { gate, .. } if self.seen == 0 => {
                let text = format!("`{gate}` has sent nothing");
                Some(self.failed(None, text, "a condition that must always hold was never tried".to_owned()))
            }
            Expected::Always { .. } => self.failure,
            Expected::Eventually { .. } if self.met => None,
            Expected::Eventually { gate, by, .. } => {
                let by_then = by.map_or_else(String::new, |by| format!(" by {}", duration::text(by)));
                let text = format!("`{gate}` has not met its condition{by_then}");
                let note = match &self.last {
                    Some((at, value)) => format!("its last message, at {:.6} s, was {value}", at.as_secs_f64()),
                    None => "it has sent nothing".to_owned(),
                };
                Some(self.failed(*by, text, note))
            }
            Expected::Exit { component, code } => {
                let ended = exit(component);
                if ended == Some(i32::from(*code)) {
                    return None;
                }
                let text = format!("`{component}` has not ended with exit code {code}");
                let note = ended.map_or("it has not ended by itself".to_owned(), |code| format!("it was {code}"));
                Some(self.failed(None, text, note))
            }
        }
    }
}
