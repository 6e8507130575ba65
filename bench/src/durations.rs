//! A histogram of durations with three significant digits.

use hdrhistogram::Histogram;

/// One minute in nanoseconds; longer durations count as one minute.
const MAX: u64 = 60_000_000_000;

/// A histogram of durations, which are recorded in nanoseconds and reported in microseconds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Durations(Histogram<u64>);

impl Durations {
    pub(crate) fn new() -> scl::Result<Self> {
        Ok(Self(Histogram::new_with_max(MAX, 3)?))
    }

    pub(crate) fn record(&mut self, nanoseconds: u64) {
        self.0.saturating_record(nanoseconds);
    }

    /// The duration that a fraction of all durations does not exceed.
    pub(crate) fn quantile(&self, fraction: f64) -> f64 {
        to_microseconds(self.0.value_at_quantile(fraction) as f64)
    }

    pub(crate) fn min(&self) -> f64 {
        to_microseconds(self.0.min() as f64)
    }

    pub(crate) fn mean(&self) -> f64 {
        to_microseconds(self.0.mean())
    }

    pub(crate) fn max(&self) -> f64 {
        to_microseconds(self.0.max() as f64)
    }

    /// Returns the variance in square microseconds.
    pub(crate) fn variance(&self) -> f64 {
        to_microseconds(self.0.stdev()).powi(2)
    }

    /// Points `(fraction, microseconds)` of the cumulative distribution, closer together towards its end.
    pub(crate) fn cumulative(&self) -> Vec<(f64, f64)> {
        let points = self.0.iter_quantiles(1);
        points.map(|point| (point.quantile_iterated_to(), to_microseconds(point.value_iterated_to() as f64))).collect()
    }

    /// The fractions of all durations in `count` logarithmic bins from `min` to `max`, in microseconds.
    pub(crate) fn log_bins(&self, min: f64, max: f64, count: usize) -> Vec<f64> {
        // A duration of zero has no logarithm.
        let [min, max] = [min, max].map(|duration| duration.max(1e-3).ln());
        let mut counts = vec![0; count];
        for value in self.0.iter_recorded() {
            let duration = to_microseconds(value.value_iterated_to() as f64);
            let position = (duration.max(1e-3).ln() - min) / (max - min);
            // Rounding may put a duration just outside the range, and the position is NaN if all durations are equal.
            // The cast saturates in both cases.
            let bin = ((position * count as f64) as usize).min(count.saturating_sub(1));
            if let Some(count) = counts.get_mut(bin) {
                *count += value.count_at_value();
            }
        }
        counts.into_iter().map(|count| count as f64 / self.0.len() as f64).collect()
    }
}

fn to_microseconds(nanoseconds: f64) -> f64 {
    nanoseconds / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_are_in_microseconds() {
        let mut durations = Durations::new().unwrap();
        for nanoseconds in [1_000, 2_000, 3_000] {
            durations.record(nanoseconds);
        }
        let statistics =
            [durations.min(), durations.quantile(0.5), durations.mean(), durations.max(), durations.variance()];
        for (value, expected) in statistics.into_iter().zip([1.0, 2.0, 2.0, 3.0, 2.0 / 3.0]) {
            assert!((value - expected).abs() < 0.01, "{statistics:?}");
        }
        assert_eq!(durations.cumulative().last().map(|(fraction, _)| *fraction), Some(1.0));
    }

    #[test]
    fn bins_are_logarithmic() {
        let mut durations = Durations::new().unwrap();
        for nanoseconds in [1_000, 2_000, 20_000, 999_000] {
            durations.record(nanoseconds);
        }
        assert_eq!(durations.log_bins(1.0, 1000.0, 3), [0.5, 0.25, 0.25]);
        let mut equal = Durations::new().unwrap();
        equal.record(5_000);
        assert_eq!(equal.log_bins(equal.min(), equal.max(), 2).iter().sum::<f64>(), 1.0);
    }
}
