//! By how much messages were sent too late, in bounded memory.

use super::report::Late;
use std::time::Duration;

/// Buckets per doubling of the time: exact to 6 %.
const STEPS: u32 = 16;

/// Counts delays in buckets that grow with the delay.
#[derive(Debug, Default)]
pub(super) struct Lateness {
    buckets: Vec<u64>,
    count: u64,
    max: Duration,
}

impl Lateness {
    pub(super) fn add(&mut self, late: Duration) {
        let index = bucket(u64::try_from(late.as_nanos()).unwrap_or(u64::MAX));
        if self.buckets.len() <= index {
            self.buckets.resize(index + 1, 0);
        }
        self.buckets[index] += 1;
        self.count += 1;
        self.max = self.max.max(late);
    }

    pub(super) fn summary(&self) -> Late {
        Late { p50: self.quantile(50), p99: self.quantile(99), max: self.max }
    }

    fn quantile(&self, percent: u64) -> Duration {
        let rank = (self.count * percent).div_ceil(100);
        let mut seen = 0;
        let reaches = |count: &u64| {
            seen += count;
            seen >= rank
        };
        let index = self.buckets.iter().position(reaches).unwrap_or_default();
        Duration::from_nanos(upper_limit(index)).min(self.max)
    }
}

fn bucket(nanoseconds: u64) -> usize {
    if nanoseconds < u64::from(STEPS) {
        return nanoseconds as usize;
    }
    let doublings = nanoseconds.ilog2() - STEPS.ilog2();
    (doublings * STEPS) as usize + (nanoseconds >> doublings) as usize
}

fn upper_limit(bucket: usize) -> u64 {
    let (bucket, steps) = (bucket as u64, u64::from(STEPS));
    if bucket < 2 * steps {
        return bucket;
    }
    let doublings = bucket / steps - 1;
    ((bucket - doublings * steps + 1) << doublings) - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_exact_to_a_sixteenth() {
        for nanoseconds in (0..100).chain([1_000, 12_345, 1_000_000, 987_654_321, u64::MAX / 3]) {
            let limit = upper_limit(bucket(nanoseconds));
            assert!(limit >= nanoseconds && limit - nanoseconds <= nanoseconds / 16, "{nanoseconds} {limit}");
        }
        let mut lateness = Lateness::default();
        (1..=100).for_each(|micros| lateness.add(Duration::from_micros(micros)));
        let Late { p50, p99, max } = lateness.summary();
        assert_eq!(max, Duration::from_micros(100));
        let near = |found: Duration, micros: u64| (found.as_secs_f64() * 1e6 / micros as f64 - 1.0).abs() < 0.07;
        assert!(near(p50, 50) && near(p99, 99), "{p50:?} {p99:?}");
    }
}
