//! How long messages take from being sent until this program sees them.

use crate::distribution::{Distribution, Spread};
use crate::measure::Meter;
use scl::tap::Observation;

/// Collects the delays of the messages of one gate.
#[derive(Debug, Default)]
pub struct DelayMeter {
    interval: Delays,
    total: Delays,
}

/// The delays in an interval, or since the measurement began.
#[derive(Debug, Clone, PartialEq)]
pub struct DelayFigures {
    /// Messages seen, requests and replies included.
    pub messages: u64,
    /// Time from sending a message until this program received it.
    pub delay: Option<Spread>,
    /// Messages that seem to have been received before they were sent, because a clock was set or two clocks differ.
    pub negative: u64,
}

#[derive(Debug, Default)]
struct Delays {
    messages: u64,
    negative: u64,
    distribution: Distribution,
}

impl DelayMeter {
    /// Counts a message by the times when it was sent and received, in nanoseconds since 1970.
    fn observe(&mut self, sent_ns: u64, received_ns: u64) {
        self.interval.add(sent_ns, received_ns);
        self.total.add(sent_ns, received_ns);
    }
}

impl Meter for DelayMeter {
    type Figures = DelayFigures;

    fn observe(&mut self, seen: &Observation) {
        self.observe(seen.sent_ns, seen.received_ns);
    }

    fn take_interval(&mut self) -> DelayFigures {
        std::mem::take(&mut self.interval).figures()
    }

    fn total(&self) -> DelayFigures {
        self.total.figures()
    }
}

impl Delays {
    fn add(&mut self, sent_ns: u64, received_ns: u64) {
        let magnitude = i64::try_from(received_ns.abs_diff(sent_ns)).unwrap_or(i64::MAX);
        let delay = if received_ns < sent_ns { -magnitude } else { magnitude };
        self.messages += 1;
        self.negative += u64::from(delay < 0);
        self.distribution.add(delay);
    }

    fn figures(&self) -> DelayFigures {
        DelayFigures { messages: self.messages, delay: self.distribution.spread(), negative: self.negative }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn delays_are_differences_of_times_and_may_be_negative() {
        let mut meter = DelayMeter::default();
        for (sent, received) in [(1_000, 1_300), (2_000, 1_900), (3_000, 3_000)] {
            meter.observe(sent, received);
        }
        let figures = meter.take_interval();
        let delay = figures.delay.unwrap();
        assert_eq!((figures.messages, figures.negative), (3, 1));
        assert_eq!((delay.min, delay.p50, delay.max), (-100, 0, 300));
        assert_eq!(meter.take_interval(), DelayFigures { messages: 0, delay: None, negative: 0 });
        meter.observe(0, u64::MAX);
        assert_eq!(meter.take_interval().delay.map(|delay| delay.max), Some(i64::MAX));
        assert_eq!((meter.total().messages, meter.total().negative), (4, 1));
    }
}
