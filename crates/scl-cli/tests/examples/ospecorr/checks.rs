//! How long primary users are disturbed, and what was out of order meanwhile.

use super::recording::Recording;
use crate::radio::ospecorr::Truth;
use serde_json::{Value, json};
use std::fmt;

/// The time between two quiet periods.
pub(super) const SLOT_US: u64 = 20_000;

/// The quality of service is measured over this time, so an outage has consequences for as long.
const SERVICE_WINDOW_US: u64 = 500_000;

/// A primary user has come to a channel that the radio used.
#[derive(Debug)]
pub(super) struct Silence {
    /// The first slot with the primary user.
    pub(super) arrival_us: u64,
    /// The first slot from which on the radio did not transmit on this channel while the primary user was there.
    silent_us: u64,
}

impl Silence {
    pub(super) fn slots(&self) -> u64 {
        (self.silent_us - self.arrival_us) / SLOT_US
    }
}

/// All visits of primary users that the radio disturbed.
pub(super) fn silences(truth: &[Truth]) -> Vec<Silence> {
    let mut silences = Vec::new();
    let channels = truth.iter().flat_map(|it| &it.primary_channels).max().map_or(0, |it| it + 1);
    for channel in 0..channels {
        for visit in truth.chunk_by(|a, b| is_used(a, channel) == is_used(b, channel)) {
            let disturbs = |it: &&Truth| it.transmitting && it.channel == channel;
            if is_used(&visit[0], channel)
                && let Some(last) = visit.iter().rfind(disturbs)
            {
                silences.push(Silence { arrival_us: visit[0].time_us, silent_us: last.time_us + SLOT_US });
            }
        }
    }
    silences.sort_by_key(|it| it.arrival_us);
    silences
}

fn is_used(truth: &Truth, channel: u32) -> bool {
    truth.primary_channels.contains(&channel)
}

/// The time in which a part was dead, until its next process has sent its first message.
pub(super) struct Outage {
    component: String,
    from_us: u64,
    to_us: u64,
}

impl Outage {
    #[track_caller]
    pub(super) fn of(recording: &Recording, component: &str, from_us: u64) -> Self {
        let mut starts = recording.starts.iter().filter(|(name, at)| name == component && *at >= from_us);
        let (_, to_us) = starts.next().unwrap_or_else(|| panic!("`{component}` has sent nothing after it was killed"));
        Self { component: component.to_owned(), from_us, to_us: *to_us }
    }

    /// Whether a time is in it, or so shortly after it that the quality of service still contains it.
    ///
    /// Nobody waits for the resource map, so its outage is no excuse for anything.
    pub(super) fn disturbs(&self, time_us: u64) -> bool {
        self.component != "resource_map" && (self.from_us..=self.to_us + SERVICE_WINDOW_US).contains(&time_us)
    }

    fn milliseconds(&self) -> u64 {
        (self.to_us - self.from_us) / 1000
    }

    pub(super) fn to_json(&self) -> Value {
        json!({"component": self.component, "from_us": self.from_us, "milliseconds": self.milliseconds()})
    }
}

impl fmt::Display for Outage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { component, from_us, .. } = self;
        let seconds = *from_us as f64 / 1e6;
        write!(
            f,
            "`{component}` was killed at {seconds:.1} s, and its next message came {} ms later",
            self.milliseconds()
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slots with a primary user on channel 3 (`p`), the radio there (`r`), both (`b`), or neither (`.`).
    fn slots(text: &str) -> Vec<Truth> {
        let slot = |(number, letter): (usize, char)| Truth {
            time_us: number as u64 * SLOT_US,
            primary_channels: if matches!(letter, 'p' | 'b') { vec![3] } else { Vec::new() },
            channel: if matches!(letter, 'r' | 'b') { 3 } else { 0 },
            transmitting: true,
            lost: 0,
        };
        text.chars().enumerate().map(slot).collect()
    }

    #[test]
    fn silence_begins_after_the_last_transmission_of_a_visit() {
        for (text, expected) in [
            ("....", vec![]),
            ("rrpppp", vec![]),
            ("rrbppp", vec![(2, 1)]),
            ("rrbbbp", vec![(2, 3)]),
            ("rrbpppb", vec![(2, 5)]),
            ("rrbb", vec![(2, 2)]),
            ("rbprrbbp", vec![(1, 1), (5, 2)]),
        ] {
            let found = silences(&slots(text));
            let found: Vec<_> = found.iter().map(|it| (it.arrival_us / SLOT_US, it.slots())).collect();
            assert_eq!(found, expected, "{text}");
        }
    }
}
