//! How many bytes a gate sends: bytes per second and the sizes of its messages.

use crate::measure::Meter;
use scl::tap::{Observation, ObservedKind};

/// Counts the bytes of the messages of one gate.
#[derive(Debug, Default)]
pub struct BandwidthMeter {
    previous_ns: Option<u64>,
    interval: Bytes,
    total: Bytes,
}

/// The bytes in an interval, or since the measurement began.
#[derive(Debug, Clone, PartialEq)]
pub struct BandwidthFigures {
    /// Messages seen, requests and replies included.
    pub messages: u64,
    /// Bytes of their payloads.
    pub bytes: u64,
    /// Bytes per second, by the sender's time stamps. `None` until there are two messages.
    pub per_second: Option<f64>,
    /// Smallest, mean and largest size of a message.
    pub size: Option<(u64, f64, u64)>,
}

#[derive(Debug, Default)]
struct Bytes {
    messages: u64,
    bytes: u64,
    min: u64,
    max: u64,
    /// Bytes of the messages whose predecessor is known, and the time since those predecessors.
    timed_bytes: u64,
    duration_ns: u64,
}

impl BandwidthMeter {
    /// Counts a message, given its size in bytes and its send time. A reply adds bytes but no time.
    fn observe(&mut self, kind: ObservedKind, size: usize, sent_ns: u64) {
        let size = size as u64;
        let duration_ns = match kind {
            // The few microseconds from a request to its reply say nothing about bytes per second.
            ObservedKind::Reply => self.previous_ns.map(|_| 0),
            _ => self.previous_ns.replace(sent_ns).and_then(|previous| sent_ns.checked_sub(previous)),
        };
        self.interval.add(size, duration_ns);
        self.total.add(size, duration_ns);
    }
}

impl Meter for BandwidthMeter {
    type Figures = BandwidthFigures;

    fn observe(&mut self, seen: &Observation) {
        self.observe(seen.kind, seen.payload.len(), seen.sent_ns);
    }

    /// The tap was disconnected: the time until the next message is not counted.
    fn interrupt(&mut self) {
        self.previous_ns = None;
    }

    fn take_interval(&mut self) -> BandwidthFigures {
        std::mem::take(&mut self.interval).figures()
    }

    fn total(&self) -> BandwidthFigures {
        self.total.figures()
    }
}

impl Bytes {
    fn add(&mut self, size: u64, duration_ns: Option<u64>) {
        self.min = if self.messages == 0 { size } else { self.min.min(size) };
        self.max = self.max.max(size);
        self.messages += 1;
        self.bytes += size;
        if let Some(duration_ns) = duration_ns {
            self.timed_bytes += size;
            self.duration_ns = self.duration_ns.saturating_add(duration_ns);
        }
    }

    fn figures(&self) -> BandwidthFigures {
        let mean = self.bytes as f64 / self.messages as f64;
        BandwidthFigures {
            messages: self.messages,
            bytes: self.bytes,
            per_second: (self.duration_ns > 0).then(|| self.timed_bytes as f64 * 1e9 / self.duration_ns as f64),
            size: (self.messages > 0).then_some((self.min, mean, self.max)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ObservedKind::{Message, Reply, Request};

    #[test]
    fn bytes_are_counted_per_second_of_the_sender() {
        let mut meter = BandwidthMeter::default();
        let none = BandwidthFigures { messages: 0, bytes: 0, per_second: None, size: None };
        assert_eq!(meter.take_interval(), none);
        meter.observe(Message, 1000, 0);
        meter.observe(Message, 10, 500_000_000);
        meter.observe(Message, 40, 1_000_000_000);
        let expected =
            BandwidthFigures { messages: 3, bytes: 1050, per_second: Some(50.0), size: Some((10, 350.0, 1000)) };
        assert_eq!(meter.take_interval(), expected);
        meter.interrupt();
        meter.observe(Message, 0, 9_000_000_000);
        assert_eq!(meter.take_interval(), BandwidthFigures { messages: 1, size: Some((0, 0.0, 0)), ..none });
        assert_eq!((meter.total().messages, meter.total().per_second), (4, Some(50.0)));
    }

    #[test]
    fn replies_add_bytes_and_no_time() {
        let mut meter = BandwidthMeter::default();
        for (kind, size, ms) in [(Reply, 1, 0), (Request, 7, 1), (Reply, 5, 2), (Request, 7, 1001), (Reply, 5, 1002)] {
            meter.observe(kind, size, ms * 1_000_000);
        }
        assert_eq!(meter.total().per_second, Some(17.0));
    }
}
