//! Messages that do not come when they are due, by the options `period` (or `rate`) and `deadline`.

use crate::sync::lock;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

/// Counts the messages that are missing from a series. The counts only rise, and no timer runs: time without a message
/// is counted when the next one comes, or when somebody asks.
#[derive(Debug)]
pub(super) struct Due {
    interval: Duration,
    /// How late a message may be.
    grace: Duration,
    /// The last message, or when the series began; `None` before that.
    last: Option<Instant>,
    /// Those that were missing before `last`.
    missed: u64,
}

impl Due {
    /// For a sender that promises a message in each `period`. One that is less than half a period late counts as sent
    /// in time: no loop is exact.
    pub(super) fn promised(period: Duration) -> Self {
        Self::new(period, period / 2)
    }

    /// For a receiver that needs a message within each `deadline`.
    pub(super) fn needed(deadline: Duration) -> Self {
        Self::new(deadline, Duration::ZERO)
    }

    fn new(interval: Duration, grace: Duration) -> Self {
        debug_assert!(!interval.is_zero(), "plans are validated");
        Self { interval, grace, last: None, missed: 0 }
    }

    /// Begins the series, unless it has begun.
    pub(super) fn begin(&mut self, now: Instant) {
        self.last.get_or_insert(now);
    }

    /// Ends the series until it begins again: nothing is due in between.
    pub(super) fn end(&mut self, now: Instant) {
        self.missed = self.missed(now);
        self.last = None;
    }

    /// Counts a message, which begins the series if it is the first.
    pub(super) fn add(&mut self, now: Instant) {
        self.missed = self.missed(now);
        self.last = Some(now);
    }

    /// How many messages were missing so far.
    pub(super) fn missed(&self, now: Instant) -> u64 {
        let waited = self.last.map_or(Duration::ZERO, |last| now.saturating_duration_since(last));
        let late = waited.saturating_sub(self.grace);
        // A message that comes exactly in time is not late.
        let missing = late.as_nanos().saturating_sub(1) / self.interval.as_nanos();
        self.missed.saturating_add(u64::try_from(missing).unwrap_or(u64::MAX))
    }

    /// When one more message will be missing, unless one comes before; `None` while nothing is due.
    pub(super) fn next(&self, now: Instant) -> Option<Instant> {
        let last = self.last?;
        let missing = self.missed(now) - self.missed;
        let intervals = u32::try_from(missing.saturating_add(1)).unwrap_or(u32::MAX);
        let late = self.grace.saturating_add(self.interval.saturating_mul(intervals));
        // A message that comes exactly in time is not late.
        let next = last.checked_add(late)?.checked_add(Duration::from_nanos(1))?;
        debug_assert!(next > now || intervals == u32::MAX, "what is missing already is counted");
        Some(next)
    }
}

/// The series of a sending gate, which its figures share; `None` if it promises nothing.
#[derive(Clone)]
pub(super) struct SharedDue(Option<Arc<Mutex<Due>>>);

impl SharedDue {
    pub(super) fn promised(period: Option<Duration>) -> Self {
        Self(period.map(|period| Arc::new(Mutex::new(Due::promised(period)))))
    }

    /// Counts a message.
    pub(super) fn add(&self) {
        if let Some(due) = &self.0 {
            lock(due).add(Instant::now());
        }
    }

    /// How many messages were missing so far.
    pub(super) fn missed(&self) -> u64 {
        self.0.as_ref().map_or(0, |due| lock(due).missed(Instant::now()))
    }

    /// [`missed`](Self::missed) for somebody who may outlive the gate, as long as it exists.
    pub(super) fn missed_later(&self) -> impl Fn() -> Option<u64> + Send + Sync + use<> {
        let due: Option<Weak<Mutex<Due>>> = self.0.as_ref().map(Arc::downgrade);
        move || Some(lock(&*due.as_ref()?.upgrade()?).missed(Instant::now()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MS: Duration = Duration::from_millis(1);

    /// What is missing after messages at these milliseconds, asked at the last one.
    fn missed(mut due: Due, messages: &[u64], asked: u64) -> u64 {
        let start = Instant::now();
        let at = |ms: u64| start + Duration::from_millis(ms);
        messages.iter().for_each(|ms| due.add(at(*ms)));
        due.missed(at(asked))
    }

    #[test]
    fn a_promise_allows_for_half_a_period() {
        let promised = || Due::promised(10 * MS);
        assert_eq!(missed(promised(), &[], 1000), 0);
        assert_eq!(missed(promised(), &[0, 10, 21, 30, 45], 60), 0);
        assert_eq!(missed(promised(), &[0, 16], 20), 1);
        assert_eq!(missed(promised(), &[0, 20, 40], 40), 2);
        assert_eq!(missed(promised(), &[0, 35], 35), 2);
        assert_eq!(missed(promised(), &[0], 1000), 99);
    }

    #[test]
    fn a_need_allows_for_nothing() {
        let needed = || Due::needed(10 * MS);
        assert_eq!(missed(needed(), &[0, 10, 20], 30), 0);
        assert_eq!(missed(needed(), &[0, 11], 21), 1);
        assert_eq!(missed(needed(), &[0], 35), 3);
    }

    #[test]
    fn the_next_one_is_missing_as_soon_as_it_is_late() {
        let start = Instant::now();
        let nanosecond = Duration::from_nanos(1);
        for mut due in [Due::needed(10 * MS), Due::promised(10 * MS)] {
            assert_eq!(due.next(start), None);
            due.begin(start);
            let mut now = start;
            for count in 1..4 {
                now = due.next(now).unwrap();
                assert_eq!((due.missed(now - nanosecond), due.missed(now)), (count - 1, count));
            }
            due.add(now);
            assert_eq!(due.next(now), Some(now + due.interval + due.grace + nanosecond));
            due.end(now);
            assert_eq!(due.next(now), None);
        }
        let mut rare = Due::needed(Duration::MAX);
        rare.begin(start);
        assert_eq!(rare.next(start), None, "no time is as late");
    }

    #[test]
    fn nothing_is_due_outside_of_a_series() {
        let start = Instant::now();
        let mut due = Due::needed(10 * MS);
        assert_eq!(due.missed(start + 100 * MS), 0);
        due.begin(start + 100 * MS);
        due.begin(start + 200 * MS);
        assert_eq!(due.missed(start + 125 * MS), 2);
        due.end(start + 125 * MS);
        assert_eq!(due.missed(start + 500 * MS), 2);
        due.begin(start + 500 * MS);
        assert_eq!(due.missed(start + 515 * MS), 3);
    }
}
