//! The distribution of a measured quantity in nanoseconds, which may be negative where two clocks are compared.

use hdrhistogram::Histogram;

/// Percentiles are exact to three digits; a histogram of periods around 1 ms takes about 100 kB.
const DIGITS: u8 = 3;

/// Collects values. Minimum, maximum, mean and standard deviation are exact, percentiles to 0.1 %.
#[derive(Debug, Clone, Default)]
pub struct Distribution {
    /// Values of 0 and above.
    positive: Option<Histogram<u64>>,
    /// Values below 0, without their sign.
    negative: Option<Histogram<u64>>,
    count: u64,
    min: i64,
    max: i64,
    mean: f64,
    /// Sum of the squared differences from the mean (Welford's algorithm), because histograms round too much for a
    /// jitter that is small compared with the values.
    squares: f64,
}

/// Summary of a distribution, in nanoseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Smallest value.
    pub min: i64,
    /// Median.
    pub p50: i64,
    /// 99th percentile.
    pub p99: i64,
    /// Largest value.
    pub max: i64,
    /// Arithmetic mean.
    pub mean: f64,
    /// Standard deviation.
    pub deviation: f64,
}

impl Distribution {
    /// Adds a value.
    pub fn add(&mut self, value: i64) {
        let half = if value < 0 { &mut self.negative } else { &mut self.positive };
        if half.is_none() {
            // Fails only for more than 5 digits.
            *half = Histogram::new(DIGITS).ok();
        }
        if let Some(half) = half {
            // Such a histogram grows as needed, so no value is out of its range.
            let _ = half.record(value.unsigned_abs());
        }
        self.min = if self.count == 0 { value } else { self.min.min(value) };
        self.max = if self.count == 0 { value } else { self.max.max(value) };
        self.count += 1;
        let difference = value as f64 - self.mean;
        self.mean += difference / self.count as f64;
        self.squares += difference * (value as f64 - self.mean);
    }

    /// Returns a summary of the values; `None` if there are none.
    pub fn spread(&self) -> Option<Spread> {
        (self.count > 0).then(|| Spread {
            min: self.min,
            p50: self.percentile(50),
            p99: self.percentile(99),
            max: self.max,
            mean: self.mean,
            deviation: (self.squares / self.count as f64).sqrt(),
        })
    }

    /// The smallest value that `percent` of all values do not exceed.
    fn percentile(&self, percent: u64) -> i64 {
        let rank = (self.count * percent).div_ceil(100).max(1);
        let negatives = self.negative.as_ref().map_or(0, Histogram::len);
        let at_rank = |half: &Option<Histogram<u64>>, rank: u64| {
            let half = half.as_ref()?;
            i64::try_from(half.value_at_quantile(rank as f64 / half.len() as f64)).ok()
        };
        let value = if rank <= negatives {
            at_rank(&self.negative, negatives - rank + 1).map(|value| -value)
        } else {
            at_rank(&self.positive, rank - negatives)
        };
        // A histogram returns the upper end of the range that the value is in.
        value.unwrap_or(self.max).clamp(self.min, self.max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spread_of(values: impl IntoIterator<Item = i64>) -> Option<Spread> {
        let mut distribution = Distribution::default();
        values.into_iter().for_each(|value| distribution.add(value));
        distribution.spread()
    }

    /// Whether a percentile is as exact as it should be.
    fn is_about(found: i64, expected: i64) -> bool {
        (found - expected).abs() <= expected.abs() / 1000
    }

    #[test]
    fn percentiles_extremes_and_deviation_are_those_of_the_values() {
        let spread = spread_of((1..=1000).map(|number| number * 1_000_000)).unwrap();
        assert_eq!((spread.min, spread.max), (1_000_000, 1_000_000_000));
        assert!(is_about(spread.p50, 500_000_000), "{spread:?}");
        assert!(is_about(spread.p99, 990_000_000), "{spread:?}");
        assert!((spread.mean - 500.5e6).abs() < 1.0, "{spread:?}");
        assert!((spread.deviation - 288.674_99e6).abs() < 10.0, "{spread:?}");
    }

    #[test]
    fn a_deviation_far_below_the_resolution_of_percentiles_is_exact() {
        let spread = spread_of([100_000_000, 100_000_002].repeat(50)).unwrap();
        assert!((spread.deviation - 1.0).abs() < 1e-3, "{spread:?}");
        assert_eq!((spread.min, spread.max), (100_000_000, 100_000_002));
    }

    #[test]
    fn negative_values_are_ordered_before_positive_ones() {
        let spread = spread_of((-60..40).map(|number| number * 1000)).unwrap();
        assert_eq!((spread.min, spread.max), (-60_000, 39_000));
        assert!(is_about(spread.p50, -11_000), "{spread:?}");
        assert!(is_about(spread.p99, 38_000), "{spread:?}");
        let all_negative = spread_of([-3, -2, -1]).unwrap();
        assert_eq!((all_negative.min, all_negative.p50, all_negative.max), (-3, -2, -1));
    }

    #[test]
    fn nothing_has_no_spread_and_extreme_values_have_one() {
        assert_eq!(spread_of([]), None);
        let spread = spread_of([i64::MIN, i64::MAX, 0]).unwrap();
        assert_eq!((spread.min, spread.p50, spread.max), (i64::MIN, 0, i64::MAX));
        let one = spread_of([7]).unwrap();
        assert_eq!((one.min, one.p50, one.p99, one.max, one.deviation), (7, 7, 7, 7, 0.0));
    }
}
