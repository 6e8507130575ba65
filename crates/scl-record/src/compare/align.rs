//! Pairs the messages of one topic, and finds those that only one recording has.
//!
//! Equal messages are paired in order. Where the messages differ, the search looks for the next position from which
//! both recordings agree again: first where the gate's own numbers say that messages are missing, then by content.

use super::CompareOptions;
use super::report::{Difference, DifferenceKind, GateComparison};
use super::side::{Side, Waiting};
use super::values::{FieldDifference, Rules, shown_message};
use crate::format::Topic;
use std::collections::VecDeque;
use std::time::Duration;

/// How far ahead each recording is searched for a position from which both agree again, in messages and in bytes.
const WINDOW: usize = 16 << 10;
const WINDOW_BYTES: usize = 32 << 20;

/// Up to [`NEAR`] messages after the recordings begin to differ, the search also tries gaps on both sides at once, the
/// shorter one of fewer than [`BOTH`] messages. Trying that at any distance would take too long.
const NEAR: usize = 256;
const BOTH: usize = 16;

/// The comparison of one topic.
pub(super) struct Alignment {
    gate: GateComparison,
    shown: usize,
    times_within: Option<Duration>,
    /// Send times of the first pair of messages.
    starts: Option<[u64; 2]>,
    /// How far the second recording's numbers were ahead of the first one's at the last equal pair.
    ahead: Option<u32>,
    /// The run of missing or additional messages that the next one of the same kind extends: its kind, and whether its
    /// difference was kept.
    gap: Option<(DifferenceKind, bool)>,
}

/// What to do with the first messages of both queues.
enum Step {
    Equal,
    /// The recordings agree again after these numbers of messages.
    Resume([usize; 2]),
    /// The recordings do not agree again within the window; this many messages of both are paired as they are.
    Unlike(usize),
    /// Only one side has messages left: the first (`Missing`) or the second (`Additional`).
    Rest(DifferenceKind),
    /// More messages are needed to decide.
    Wait,
}

impl Alignment {
    pub(super) fn new(topic: &Topic, options: &CompareOptions) -> Self {
        let gate = GateComparison::new(topic);
        let (shown, times_within) = (options.shown, options.times_within);
        Self { gate, shown, times_within, starts: None, ahead: None, gap: None }
    }

    /// Pairs and compares the messages read so far, until more are needed to decide.
    pub(super) fn advance(&mut self, sides: &mut [Side; 2], topic: usize, rules: &mut Rules<'_>) {
        loop {
            match self.next_step(sides, topic, rules) {
                Step::Equal => self.pair(sides, topic, rules),
                Step::Unlike(count) => (0..count).for_each(|_| self.pair(sides, topic, rules)),
                Step::Resume([ones, others]) => {
                    let pairs = ones.min(others);
                    (0..pairs).for_each(|_| self.pair(sides, topic, rules));
                    (pairs..ones).for_each(|_| self.single(sides, topic, DifferenceKind::Missing));
                    (pairs..others).for_each(|_| self.single(sides, topic, DifferenceKind::Additional));
                }
                Step::Rest(kind) => self.single(sides, topic, kind),
                Step::Wait => return,
            }
        }
    }

    pub(super) fn finish(self) -> GateComparison {
        self.gate
    }

    fn next_step(&self, sides: &[Side; 2], topic: usize, rules: &mut Rules<'_>) -> Step {
        let topics = sides.each_ref().map(|side| &side.topics[topic]);
        let queues = topics.map(|topic| &topic.waiting);
        let is_complete = topics.map(|topic| topic.left == 0);
        let (one, other) = match (queues[0].front(), queues[1].front()) {
            (Some(one), Some(other)) => (one, other),
            (Some(_), None) if is_complete[1] => return Step::Rest(DifferenceKind::Missing),
            (None, Some(_)) if is_complete[0] => return Step::Rest(DifferenceKind::Additional),
            _ => return Step::Wait,
        };
        if rules.difference(sides, [one, other]).is_none() {
            return Step::Equal;
        }
        let has_enough = |side: usize| {
            let length = queues[side].len();
            is_complete[side] || length > WINDOW || length > BOTH && topics[side].bytes > WINDOW_BYTES
        };
        if !has_enough(0) || !has_enough(1) {
            return Step::Wait;
        }
        // Returns true if `count` messages in a row are equal on both sides.
        let mut agree = |[one, other]: [usize; 2], count: usize| {
            (0..count).all(|more| match (queues[0].get(one + more), queues[1].get(other + more)) {
                (Some(one), Some(other)) => rules.difference(sides, [one, other]).is_none(),
                // Both recordings end here.
                (None, None) => is_complete == [true, true],
                _ => false,
            })
        };
        // First try the gap that the sequence numbers suggest: a periodic signal agrees at other positions, too.
        if let Some(at) = self.numbered_gap(queues).filter(|at| agree(*at, 2)) {
            return Step::Resume(at);
        }
        let lengths = queues.map(VecDeque::len);
        for far in 1..lengths[0].max(lengths[1]) + 1 {
            // A changed message is more likely than a missing and an additional one.
            let is_near = far == 1 && agree([1, 1], 1);
            let gaps = (0..if far <= NEAR { far.min(BOTH) } else { 1 }).flat_map(|less| [[far, less], [less, far]]);
            let found = if is_near { Some([1, 1]) } else { gaps.chain([[far, far]]).find(|at| agree(*at, 2)) };
            if let Some(at) = found {
                return Step::Resume(at);
            }
        }
        // Skip half of the window: the recordings may agree again just beyond it. Not less, because the next search
        // costs as much as this one.
        Step::Unlike((lengths[0].min(lengths[1]) / 2).max(1))
    }

    /// Returns how many messages to skip on each side, according to the numbers that gates give to messages; `None` if
    /// these show no gap.
    fn numbered_gap(&self, queues: [&VecDeque<Waiting>; 2]) -> Option<[usize; 2]> {
        let [one, other] = queues.map(VecDeque::front);
        let (one, other) = (one?, other?);
        let ahead = other.sequence.wrapping_sub(one.sequence).wrapping_sub(self.ahead?) as i32;
        let skipped = |queue: &VecDeque<Waiting>, by: u32| {
            let first = queue.front()?.sequence;
            queue.iter().position(|message| message.sequence.wrapping_sub(first) >= by)
        };
        match ahead {
            0 => None,
            1.. => Some([skipped(queues[0], ahead.unsigned_abs())?, 0]),
            _ => Some([0, skipped(queues[1], ahead.unsigned_abs())?]),
        }
    }

    fn pair(&mut self, sides: &mut [Side; 2], topic: usize, rules: &mut Rules<'_>) {
        let (Some(one), Some(other)) = (sides[0].pop(topic), sides[1].pop(topic)) else { return };
        self.gate.paired += 1;
        self.gap = None;
        let starts = *self.starts.get_or_insert([one.sent_ns, other.sent_ns]);
        let difference = rules.difference(sides, [&one, &other]);
        if difference.is_none() {
            self.ahead = Some(other.sequence.wrapping_sub(one.sequence));
        }
        let difference = difference.or_else(|| self.time_difference(starts, &one, &other));
        let Some(FieldDifference { field, values }) = difference else { return };
        self.gate.different += 1;
        self.keep(sides, &one, DifferenceKind::Different, field.to_string(), values);
    }

    fn single(&mut self, sides: &mut [Side; 2], topic: usize, kind: DifferenceKind) {
        let side = if kind == DifferenceKind::Missing { 0 } else { 1 };
        let Some(message) = sides[side].pop(topic) else { return };
        match side {
            0 => self.gate.missing += 1,
            _ => self.gate.additional += 1,
        }
        match (self.gap, self.gate.differences.last_mut()) {
            (Some((open, true)), Some(gap)) if open == kind => {
                gap.count += 1;
                gap.until = sides[side].since_start(message.sent_ns);
            }
            (Some((open, false)), _) if open == kind => {}
            _ => {
                let value = shown_message(&sides[side].types[message.channel], &message.payload);
                let values = if side == 0 { [Some(value), None] } else { [None, Some(value)] };
                let is_kept = self.keep(sides, &message, kind, String::new(), values);
                self.gap = Some((kind, is_kept));
            }
        }
    }

    /// Keeps a difference for the report; returns false if enough are kept already.
    fn keep(
        &mut self,
        sides: &[Side; 2],
        message: &Waiting,
        kind: DifferenceKind,
        field: String,
        values: [Option<String>; 2],
    ) -> bool {
        let is_kept = self.gate.differences.len() < self.shown;
        if is_kept {
            let side = usize::from(kind == DifferenceKind::Additional);
            let time = sides[side].since_start(message.sent_ns);
            let (index, count, until) = (message.index, 1, time);
            self.gate.differences.push(Difference { kind, index, count, time, until, field, values });
        }
        is_kept
    }

    /// Compares the send times of a pair, each counted from the first pair of the topic.
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
