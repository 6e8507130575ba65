//! How often a gate sends: rate, periods and jitter from the sender's time stamps, and what the observer missed.

use crate::distribution::{Distribution, Spread};
use crate::measure::Meter;
use scl::tap::{Observation, ObservedKind};
use std::collections::VecDeque;

/// Counts the frames at the tap of one gate.
#[derive(Debug, Default)]
pub struct RateMeter {
    /// Frames of the current connection to the tap.
    session: Option<Session>,
    /// The last messages, if the figures of an interval cover a fixed number of messages.
    window: Option<Window>,
    interval: Totals,
    total: Totals,
}

/// The rate of a gate in an interval, in the last messages, or since the measurement began.
#[derive(Debug, Clone, PartialEq)]
pub struct RateFigures {
    /// Messages seen; at a `rep` gate requests.
    pub messages: u64,
    /// Messages sent per second, also counting those that were missed. `None` until there are two messages.
    pub rate: Option<f64>,
    /// Time between two successive messages, measured by the sender.
    pub period: Option<Spread>,
    /// Messages that were dropped at the tap because this program did not read fast enough.
    pub lost: u64,
}

#[derive(Debug)]
struct Session {
    first: u64,
    highest: u64,
    previous: Option<Sent>,
    /// The number of the previous frame, of any kind.
    last_sequence: u64,
}

#[derive(Debug, Clone, Copy)]
struct Sent {
    sequence: u64,
    at_ns: u64,
}

/// What one frame adds to the figures.
#[derive(Debug, Clone, Copy, Default)]
struct Step {
    /// 1 for a message or a request, 0 for a reply.
    messages: u64,
    /// Number of messages since the previous one seen, this one included, and the time since that one.
    sent: Option<(u64, u64)>,
    /// The time since the previous message, if none was missed in between.
    period: Option<u64>,
    /// Number of frames missed just before this one; -1 if this one is late and had been counted as missed.
    lost: i64,
}

#[derive(Debug, Default)]
struct Totals {
    messages: u64,
    sent: u64,
    duration_ns: u64,
    periods: Distribution,
    lost: i64,
}

#[derive(Debug)]
struct Window {
    limit: usize,
    steps: VecDeque<Step>,
}

impl RateMeter {
    /// Creates a meter. With a `window`, its intervals show that many of the last messages.
    pub fn new(window: Option<usize>) -> Self {
        let window = window.map(|limit| Window { limit, steps: VecDeque::new() });
        Self { window, ..Self::default() }
    }

    /// Counts a frame. Replies are not counted as messages, but missing replies count as lost frames.
    fn observe(&mut self, kind: ObservedKind, sequence: u64, sent_ns: u64) {
        let step = match &mut self.session {
            Some(session) => session.step(kind, sequence, sent_ns),
            None => {
                self.session = Some(Session::new(kind, sequence, sent_ns));
                Step { messages: u64::from(kind != ObservedKind::Reply), ..Step::default() }
            }
        };
        self.total.add(&step);
        match &mut self.window {
            Some(window) => window.add(step),
            None => self.interval.add(&step),
        }
    }
}

impl Meter for RateMeter {
    type Figures = RateFigures;

    fn observe(&mut self, seen: &Observation) {
        self.observe(seen.kind, seen.sequence, seen.sent_ns);
    }

    fn interrupt(&mut self) {
        self.session = None;
    }

    // Returns the figures of the window, if there is one.
    fn take_interval(&mut self) -> RateFigures {
        if let Some(window) = &self.window {
            return window.figures();
        }
        std::mem::take(&mut self.interval).figures()
    }

    fn total(&self) -> RateFigures {
        self.total.figures()
    }
}

impl Session {
    fn new(kind: ObservedKind, sequence: u64, sent_ns: u64) -> Self {
        let previous = (kind != ObservedKind::Reply).then_some(Sent { sequence, at_ns: sent_ns });
        Self { first: sequence, highest: sequence, previous, last_sequence: sequence }
    }

    fn step(&mut self, kind: ObservedKind, sequence: u64, sent_ns: u64) -> Step {
        let lost = self.count_lost(sequence);
        let is_next = sequence == self.last_sequence.wrapping_add(1);
        self.last_sequence = sequence;
        if !is_next && kind != ObservedKind::Message {
            // Whether the missing frames were requests or replies is unknown.
            self.previous = None;
        }
        if kind == ObservedKind::Reply {
            return Step { lost, ..Step::default() };
        }
        let sent = Sent { sequence, at_ns: sent_ns };
        let (mut advance, mut period) = (None, None);
        // Threads that send at the same time may overtake each other, and the clock may be set back.
        if let Some(before) = self.previous
            && let Some(messages) = sequence.checked_sub(before.sequence)
            && let Some(duration) = sent_ns.checked_sub(before.at_ns)
        {
            advance = Some((if kind == ObservedKind::Request { 1 } else { messages }, duration));
            period = is_next.then_some(duration);
        }
        self.previous = Some(sent);
        Step { messages: 1, sent: advance, period, lost }
    }

    /// Returns the number of frames that this one shows to be missing; -1 if it is late and had been counted as
    /// missing.
    fn count_lost(&mut self, sequence: u64) -> i64 {
        let missing = if sequence > self.highest {
            let missing = sequence - self.highest - 1;
            self.highest = sequence;
            missing
        } else if sequence < self.first {
            let missing = self.first - sequence - 1;
            self.first = sequence;
            missing
        } else {
            return -1;
        };
        i64::try_from(missing).unwrap_or(i64::MAX)
    }
}

impl Totals {
    fn add(&mut self, step: &Step) {
        self.messages += step.messages;
        if let Some((sent, duration_ns)) = step.sent {
            self.sent = self.sent.saturating_add(sent);
            self.duration_ns = self.duration_ns.saturating_add(duration_ns);
        }
        if let Some(period) = step.period {
            self.periods.add(i64::try_from(period).unwrap_or(i64::MAX));
        }
        self.lost = self.lost.saturating_add(step.lost);
    }

    fn figures(&self) -> RateFigures {
        let rate = (self.duration_ns > 0).then(|| self.sent as f64 * 1e9 / self.duration_ns as f64);
        RateFigures {
            messages: self.messages,
            rate,
            period: self.periods.spread(),
            lost: self.lost.max(0).unsigned_abs(),
        }
    }
}

impl Window {
    fn add(&mut self, step: Step) {
        if step.messages == 0 && step.lost == 0 {
            return;
        }
        if self.steps.len() >= self.limit {
            self.steps.pop_front();
        }
        self.steps.push_back(step);
    }

    fn figures(&self) -> RateFigures {
        let mut totals = Totals::default();
        self.steps.iter().for_each(|step| totals.add(step));
        totals.figures()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ObservedKind::{Message, Reply, Request};

    const MS: u64 = 1_000_000;

    /// The figures of frames, given as kind, sequence and time in milliseconds; `None` is a broken connection.
    fn figures(window: Option<usize>, frames: &[Option<(ObservedKind, u64, u64)>]) -> [RateFigures; 2] {
        let mut meter = RateMeter::new(window);
        for frame in frames {
            match frame {
                Some((kind, sequence, ms)) => meter.observe(*kind, *sequence, ms * MS),
                None => meter.interrupt(),
            }
        }
        [meter.take_interval(), meter.total()]
    }

    /// `messages rate min..max lost`, periods in milliseconds.
    fn shown(figures: &RateFigures) -> String {
        let RateFigures { messages, rate, period, lost } = figures;
        let rate = rate.map_or("-".to_owned(), |rate| format!("{rate:.1}"));
        let period = period.map_or("-".to_owned(), |p| format!("{}..{}", p.min / MS as i64, p.max / MS as i64));
        format!("{messages} {rate} {period} {lost}")
    }

    fn messages(frames: &[(u64, u64)]) -> Vec<Option<(ObservedKind, u64, u64)>> {
        frames.iter().map(|&(sequence, ms)| Some((Message, sequence, ms))).collect()
    }

    /// What it shows, sequence and milliseconds of each message, the figures.
    type Case<'c> = (&'c str, &'c [(u64, u64)], &'c str);

    #[test]
    fn rates_periods_and_gaps_come_from_numbers_and_time_stamps() {
        let cases: &[Case<'_>] = &[
            ("nothing", &[], "0 - - 0"),
            ("one message has no rate", &[(7, 0)], "1 - - 0"),
            ("three messages are two periods", &[(7, 0), (8, 100), (9, 300)], "3 6.7 100..200 0"),
            ("missed messages are sent ones", &[(0, 0), (1, 10), (5, 50), (6, 60)], "4 100.0 10..10 3"),
            ("late messages were not missed", &[(0, 0), (2, 20), (1, 10), (3, 30)], "4 100.0 - 0"),
            ("late before the first", &[(5, 0), (3, 1)], "2 - - 1"),
            ("a clock that is set back", &[(0, 100), (1, 50), (2, 60)], "3 100.0 10..10 0"),
            (
                "the last number of all",
                &[(u64::MAX - 1, 0), (u64::MAX, 10), (0, 20)],
                "3 100.0 10..10 9223372036854775807",
            ),
        ];
        for (what, frames, expected) in cases {
            let [interval, total] = figures(None, &messages(frames));
            assert_eq!(shown(&interval), *expected, "{what}");
            assert_eq!(interval, total, "{what}");
        }
    }

    #[test]
    fn a_restarted_component_begins_again() {
        let mut frames = messages(&[(100, 0), (101, 10)]);
        frames.push(None);
        frames.extend(messages(&[(0, 5000), (1, 5020)]));
        assert_eq!(shown(&figures(None, &frames)[1]), "4 66.7 10..20 0");
    }

    #[test]
    fn requests_are_counted_and_their_replies_are_not() {
        let frames =
            [(Request, 0, 0), (Reply, 1, 4), (Request, 2, 10), (Request, 3, 30), (Reply, 4, 31), (Reply, 5, 32)];
        assert_eq!(shown(&figures(None, &frames.map(Some))[1]), "3 66.7 10..20 0");
        let with_gap = [(Request, 0, 0), (Reply, 1, 4), (Request, 5, 100), (Reply, 6, 101), (Request, 7, 110)];
        assert_eq!(shown(&figures(None, &with_gap.map(Some))[1]), "3 100.0 10..10 3");
    }

    #[test]
    fn an_interval_begins_with_the_last_message_of_the_one_before() {
        let mut meter = RateMeter::new(None);
        for (sequence, ms) in [(0, 0), (1, 100)] {
            meter.observe(Message, sequence, ms * MS);
        }
        assert_eq!(shown(&meter.take_interval()), "2 10.0 100..100 0");
        meter.observe(Message, 2, 200 * MS);
        assert_eq!(shown(&meter.take_interval()), "1 10.0 100..100 0");
        assert_eq!(shown(&meter.take_interval()), "0 - - 0");
        assert_eq!(shown(&meter.total()), "3 10.0 100..100 0");
    }

    #[test]
    fn a_window_holds_the_last_messages_whenever_it_is_read() {
        let mut meter = RateMeter::new(Some(2));
        for (sequence, ms) in [(0, 0), (1, 100), (2, 110), (4, 130)] {
            meter.observe(Message, sequence, ms * MS);
        }
        for _ in 0..2 {
            assert_eq!(shown(&meter.take_interval()), "2 100.0 10..10 1");
        }
        assert_eq!(shown(&meter.total()), "4 30.8 10..100 1");
    }
}
