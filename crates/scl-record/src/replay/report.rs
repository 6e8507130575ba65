//! What a replay has done.

use serde::{Serialize, Serializer};
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;

/// What a replay has done.
#[derive(Debug, Clone, Default)]
pub struct ReplayReport {
    /// How long it took.
    pub took: Duration,
    /// Whether it was ended by a stop request.
    pub was_stopped: bool,
    /// The recorded gates, in the order of their first messages.
    pub gates: Vec<GateReport>,
    /// Messages that were sent, but that a peer has not taken.
    pub not_taken: Vec<NotTaken>,
    /// Requests of other components to played repliers.
    pub answers: Vec<AnswerReport>,
    /// How late messages were sent; `None` for `--rate max`.
    pub late: Option<Late>,
}

/// What became of the messages of one recorded gate.
#[derive(Debug, Clone, Default, Serialize)]
pub struct GateReport {
    /// The gate in the recording: `controller.commands`.
    pub recorded: String,
    /// The gate that sent them: `user_interface.commands`.
    pub sender: Option<String>,
    /// Messages or requests sent.
    pub sent: u64,
    /// Replies received; `None` unless requests were sent.
    pub replies: Option<u64>,
    /// Messages that were not sent.
    pub skipped: u64,
    /// Why they were not sent.
    #[serde(serialize_with = "unless_empty")]
    pub reason: String,
}

/// Messages that were sent, but that a peer has not taken.
#[derive(Debug, Clone, Serialize)]
pub struct NotTaken {
    pub gate: String,
    pub peer: String,
    pub messages: u64,
    /// Whether the peer was absent at the end.
    #[serde(skip)]
    pub was_absent: bool,
    /// Why: `its queue was full`.
    pub reason: &'static str,
}

/// Requests to a played replier.
#[derive(Debug, Clone, Default, Serialize)]
pub struct AnswerReport {
    pub gate: String,
    pub answered: u64,
    /// Requests that were never recorded, and got the oldest replies left.
    pub in_order: u64,
    /// Requests for which the recording has no reply.
    pub unanswered: u64,
}

/// How late messages were sent: median, 99th percentile and maximum.
#[derive(Debug, Clone, Copy, Default)]
pub struct Late {
    pub p50: Duration,
    pub p99: Duration,
    pub max: Duration,
}

impl ReplayReport {
    /// Messages and requests sent.
    pub fn sent(&self) -> u64 {
        self.gates.iter().map(|gate| gate.sent).sum()
    }

    /// Whether a peer that was present to the end has not taken all messages.
    pub fn is_incomplete(&self) -> bool {
        self.not_taken.iter().any(|left| !left.was_absent)
    }

    /// Returns the report as text, with one line per gate.
    pub fn to_text(&self) -> String {
        let sent = self.sent();
        let ended = if self.was_stopped { "stopped: " } else { "" };
        let mut text = format!("{ended}replayed {} in {}\n", count(sent, "message"), seconds(self.took));
        let width = self.gates.iter().map(|gate| gate.recorded.len()).max().unwrap_or_default();
        for gate in &self.gates {
            let _ = write!(text, "  {:width$}  {:>9}", gate.recorded, gate.sent);
            if let Some(replies) = gate.replies {
                let _ = write!(text, " sent by {}, {} answered", gate.sender.as_deref().unwrap_or_default(), replies);
            } else if let Some(sender) = gate.sender.as_ref().filter(|sender| **sender != gate.recorded) {
                let _ = write!(text, " sent by {sender}");
            }
            if gate.skipped > 0 {
                let _ = write!(text, " (not replayed: {}; {})", gate.skipped, gate.reason);
            }
            text.push('\n');
        }
        for gate in &self.answers {
            let _ = write!(text, "  {} answered {}", gate.gate, count(gate.answered, "request"));
            if gate.in_order > 0 {
                let _ = write!(text, "; {} of them were not recorded and got the oldest unused replies", gate.in_order);
            }
            if gate.unanswered > 0 {
                let _ = write!(text, "; the recording has no reply to {} more", gate.unanswered);
            }
            text.push('\n');
        }
        for NotTaken { gate, peer, messages, reason, .. } in &self.not_taken {
            let _ = writeln!(text, "  not taken by {peer}: {} of {gate}; {reason}", count(*messages, "message"));
        }
        text
    }

    /// Returns the report as one JSON object.
    pub fn to_json(&self) -> Value {
        let micros = |time: Duration| time.as_secs_f64() * 1e6;
        json!({
            "seconds": self.took.as_secs_f64(),
            "stopped": self.was_stopped,
            "sent": self.sent(),
            "gates": self.gates,
            "answers": self.answers,
            "not_taken": self.not_taken,
            "late_us": self.late.map(
                |late| json!({"p50": micros(late.p50), "p99": micros(late.p99), "max": micros(late.max)})
            ),
        })
    }
}

/// Serializes an empty text as `null`.
fn unless_empty<S: Serializer>(text: &str, output: S) -> Result<S::Ok, S::Error> {
    Some(text).filter(|text| !text.is_empty()).serialize(output)
}

fn count(number: u64, what: &str) -> String {
    format!("{number} {what}{}", if number == 1 { "" } else { "s" })
}

fn seconds(time: Duration) -> String {
    format!("{:.1} s", time.as_secs_f64())
}
