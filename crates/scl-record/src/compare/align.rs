//! Pairs the messages of one topic, and finds those that only one recording has.

use super::CompareOptions;
use super::report::{Difference, DifferenceKind, GateComparison};
use super::side::{Side, Waiting};
use super::values::{FieldDifference, Rules, shown_message};
use crate::format::Topic;
use std::time::Duration;

/// How many messages in a row may be missing or additional to be recognized as such.
const WINDOW: usize = 16;

/// The comparison of one topic.
pub(super) struct Alignment {
    gate: GateComparison,
    shown: usize,
    times_within: Option<Duration>,
    /// Times of the first messages of both sides.
    starts: Option<[u64; 2]>,
}

/// What to do with the first messages of both queues.
enum Step {
    Equal,
    Different(FieldDifference),
    /// This many messages of the first recording are not in the second.
    Missing(usize),
    /// This many messages of the second recording are not in the first.
    Additional(usize),
    /// More messages are needed to decide.
    Wait,
}

impl Alignment {
    pub(super) fn new(topic: &Topic, options: &CompareOptions) -> Self {
        let gate = GateComparison::new(topic);
        Self { gate, shown: options.shown, times_within: options.times_within, starts: None }
    }

    /// Compares what has been read.
    pub(super) fn advance(&mut self, sides: &mut [Side; 2], topic: usize, rules: &mut Rules) {
        loop {
            match self.next_step(sides, topic, rules) {
                Step::Equal => self.pair(sides, topic, None),
                Step::Different(difference) => self.pair(sides, topic, Some(difference)),
                Step::Missing(count) => (0..count).for_each(|_| self.single(sides, topic, DifferenceKind::Missing)),
                Step::Additional(count) => {
                    (0..count).for_each(|_| self.single(sides, topic, DifferenceKind::Additional))
                }
                Step::Wait => return,
            }
        }
    }

    pub(super) fn finish(self) -> GateComparison {
        self.gate
    }

    fn next_step(&self, sides: &[Side; 2], topic: usize, rules: &mut Rules) -> Step {
        let [ones, others] = [sides[0].queue(topic), sides[1].queue(topic)];
        let is_complete = [sides[0].is_complete(topic), sides[1].is_complete(topic)];
        let (one, other) = match (ones.front(), others.front()) {
            (Some(one), Some(other)) => (one, other),
            (Some(_), None) if is_complete[1] => return Step::Missing(1),
            (None, Some(_)) if is_complete[0] => return Step::Additional(1),
            _ => return Step::Wait,
        };
        let Some(difference) = self.compare(sides, rules, one, other) else { return Step::Equal };
        let has_enough = |count: usize, is_complete: bool| is_complete || count >= WINDOW + 2;
        if !has_enough(ones.len(), is_complete[0]) || !has_enough(others.len(), is_complete[1]) {
            return Step::Wait;
        }
        let mut agree = |one: usize, other: usize| match (ones.get(one), others.get(other)) {
            (Some(one), Some(other)) => self.compare(sides, rules, one, other).is_none(),
            // Both recordings end here.
            (None, None) => true,
            _ => false,
        };
        // A message that has changed is more likely than one missing here and another one too many.
        if agree(1, 1) {
            return Step::Different(difference);
        }
        for count in 1..=WINDOW {
            if agree(count, 0) && agree(count + 1, 1) {
                return Step::Missing(count);
            }
            if agree(0, count) && agree(1, count + 1) {
                return Step::Additional(count);
            }
        }
        Step::Different(difference)
    }

    fn compare(&self, sides: &[Side; 2], rules: &mut Rules, one: &Waiting, other: &Waiting) -> Option<FieldDifference> {
        rules.difference(sides, [one, other])
    }

    fn pair(&mut self, sides: &mut [Side; 2], topic: usize, difference: Option<FieldDifference>) {
        let (Some(one), Some(other)) = (sides[0].pop(topic), sides[1].pop(topic)) else { return };
        self.gate.paired += 1;
        let starts = *self.starts.get_or_insert([one.sent_ns, other.sent_ns]);
        let difference = difference.or_else(|| self.time_difference(starts, &one, &other));
        let Some(FieldDifference { field, values }) = difference else { return };
        self.gate.different += 1;
        self.keep(sides, &one, DifferenceKind::Different, field.to_string(), values);
    }

    fn single(&mut self, sides: &mut [Side; 2], topic: usize, kind: DifferenceKind) {
        let side = if kind == DifferenceKind::Missing { 0 } else { 1 };
        let Some(message) = sides[side].pop(topic) else { return };
        let value = shown_message(sides[side].message_type(message.channel), &message.payload);
        let values = if side == 0 {
            self.gate.missing += 1;
            [Some(value), None]
        } else {
            self.gate.additional += 1;
            [None, Some(value)]
        };
        self.keep(sides, &message, kind, String::new(), values);
    }

    fn keep(
        &mut self,
        sides: &[Side; 2],
        message: &Waiting,
        kind: DifferenceKind,
        field: String,
        values: [Option<String>; 2],
    ) {
        if self.gate.differences.len() < self.shown {
            let side = usize::from(kind == DifferenceKind::Additional);
            let time = sides[side].since_start(message.sent_ns);
            self.gate.differences.push(Difference { kind, index: message.index, time, field, values });
        }
    }

    /// Times count from the first messages of the gate.
    fn time_difference(&self, starts: [u64; 2], one: &Waiting, other: &Waiting) -> Option<FieldDifference> {
        let within = self.times_within?;
        let times = [one.sent_ns.saturating_sub(starts[0]), other.sent_ns.saturating_sub(starts[1])];
        if Duration::from_nanos(times[0].abs_diff(times[1])) <= within {
            return None;
        }
        let values = times.map(|time| Some(format!("{:.6} s", Duration::from_nanos(time).as_secs_f64())));
        Some(FieldDifference { field: scl_value::FieldPath::default().field("@time"), values })
    }
}
