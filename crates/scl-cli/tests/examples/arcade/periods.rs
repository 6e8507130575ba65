//! How punctual a loop of 300 Hz is: the times between its beats.

use super::recording::Numbered;
use serde_json::{Value, json};
use std::fmt;

const PERIOD_NS: u64 = 1_000_000_000 / 300;

/// The times between consecutive beats, in nanoseconds, from short to long.
pub(super) struct Periods(Vec<u64>);

impl Periods {
    /// Of a loop that tells when each of its beats began.
    pub(super) fn between(beats_ns: &[u64]) -> Self {
        Self::sorted(beats_ns.windows(2).map(|pair| pair[1].saturating_sub(pair[0])))
    }

    /// Of the autopilot. The pause while it is started again is none of its periods.
    pub(super) fn of(beats: &[Numbered]) -> Self {
        let following = beats.windows(2).filter(|pair| pair[0].number < pair[1].number);
        Self::sorted(following.map(|pair| pair[1].beat.began_ns.saturating_sub(pair[0].beat.began_ns)))
    }

    fn sorted(periods: impl Iterator<Item = u64>) -> Self {
        let mut periods: Vec<u64> = periods.collect();
        periods.sort_unstable();
        assert!(!periods.is_empty(), "the loop had no beats");
        Self(periods)
    }

    /// Beats that came more than half a period late.
    fn late(&self) -> usize {
        self.0.len() - self.0.partition_point(|&period| period <= PERIOD_NS * 3 / 2)
    }

    /// In milliseconds.
    fn quantile(&self, quantile: f64) -> f64 {
        self.0[((self.0.len() - 1) as f64 * quantile) as usize] as f64 / 1e6
    }

    pub(super) fn to_json(&self) -> Value {
        json!({
            "periods": self.0.len(),
            "p50_ms": self.quantile(0.5),
            "p99_ms": self.quantile(0.99),
            "max_ms": self.quantile(1.0),
            "late": self.late(),
        })
    }
}

impl fmt::Display for Periods {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [p50, p99, max] = [0.5, 0.99, 1.0].map(|quantile| self.quantile(quantile));
        let (count, late) = (self.0.len(), self.late());
        write!(f, "{count} periods: p50 {p50:.3} ms, p99 {p99:.3} ms, max {max:.3} ms, {late} late")
    }
}

#[test]
fn periods_are_ranked_and_those_of_more_than_one_and_a_half_are_late() {
    let beats_ns = [0, 3_000_000, 6_300_000, 9_600_000, 14_600_001];
    let periods = Periods::between(&beats_ns);
    assert_eq!(periods.to_string(), "4 periods: p50 3.300 ms, p99 3.300 ms, max 5.000 ms, 1 late");
    assert_eq!(periods.to_json()["late"], 1);
}
