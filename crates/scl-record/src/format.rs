//! What a recording contains: names, encodings and numbers on which the writer and the readers agree.
//!
//! The recorder writes an MCAP file with the profile [`PROFILE`]; readers do not insist on it, because tools that copy
//! recordings change it. Times are nanoseconds since 1970 (`CLOCK_REALTIME`):
//! `publish_time` is when the gate sent or received the message, `log_time` is when the recorder received it. Messages
//! stand in the order of arrival at the recorder, so `log_time` of one gate never decreases unless the clock was set
//! back.

mod channel_metadata;
mod encoding;
mod missed;
mod topic;
mod totals;

pub use channel_metadata::ChannelMetadata;
pub use encoding::Encoding;
pub use missed::{MissedGate, MissedPeer};
pub use topic::{Part, Topic};
pub use totals::{GateTotals, Totals};

use std::time::Duration;

/// What the wall clock shows at the start of a simulation, since 1970, unless somebody watches: the first day of 2026.
pub const SIMULATION_START: Duration = Duration::from_secs(1_767_225_600);

/// Profile in the header of the file.
pub const PROFILE: &str = "scl";

/// Attachment: the plans of the system's components that were known, a [`scl_plan::SystemPlan`] as JSON. If components
/// started later, the file has several attachments with this name; the last one is complete.
pub const PLAN: &str = "plan.json";

/// Attachment: the values of all parameters, by component and name, as texts in JSON: `{"controller": {"gain": "2"}}`.
/// Whenever values have changed, the file gets another attachment with this name, whose `log_time` is when the recorder
/// has seen that. It looks twice a second.
pub const PARAMETERS: &str = "parameters.json";

/// Attachment: the gates that have missed messages since the recording began, as JSON: a list of [`MissedGate`]s. Like
/// the values of parameters, it is attached again whenever a count has risen.
pub const MISSED: &str = "missed.json";

/// Attachment: the topology file, if it was found.
pub const TOPOLOGY: &str = "topology.yaml";

/// Attachment: the launch file, if it was found.
pub const LAUNCH: &str = "launch.yaml";

/// MCAP's `sequence` of a message: the lower 32 bits of the tap's sequence number, so it wraps to 0 after
/// 4,294,967,295. For requests and replies, the lower 32 bits of the call id: a reply belongs to the last request of
/// the same gate before it that has the same number.
pub fn sequence(part: Part, tap_sequence: u64, call_id: u64) -> u32 {
    let number = match part {
        Part::Message => tap_sequence,
        Part::Request | Part::Reply => call_id,
    };
    number as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sequences_wrap_and_pair_requests_with_replies() {
        assert_eq!(sequence(Part::Message, u64::from(u32::MAX) + 3, 9), 2);
        assert_eq!(sequence(Part::Request, 5, 9), 9);
        assert_eq!(sequence(Part::Reply, 6, 9), 9);
    }
}
