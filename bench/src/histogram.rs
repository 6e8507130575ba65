//! Times in a histogram of three digits.

use hdrhistogram::Histogram;

/// A minute; longer times count as this one, in nanoseconds.
const LONGEST: u64 = 60_000_000_000;

/// The times of one way of doing something, in nanoseconds.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Times(Histogram<u64>);

impl Times {
    pub(crate) fn new() -> scl::Result<Self> {
        Ok(Self(Histogram::new_with_max(LONGEST, 3)?))
    }

    pub(crate) fn record(&mut self, nanoseconds: u64) {
        self.0.saturating_record(nanoseconds);
    }

    /// The time that the given part of all times does not exceed, in microseconds.
    pub(crate) fn quantile(&self, part: f64) -> f64 {
        micros(self.0.value_at_quantile(part) as f64)
    }

    pub(crate) fn least(&self) -> f64 {
        micros(self.0.min() as f64)
    }

    pub(crate) fn mean(&self) -> f64 {
        micros(self.0.mean())
    }

    pub(crate) fn greatest(&self) -> f64 {
        micros(self.0.max() as f64)
    }

    /// In square microseconds.
    pub(crate) fn variance(&self) -> f64 {
        micros(self.0.stdev()).powi(2)
    }

    /// `(part, microseconds)` along the whole distribution, closer together towards its end.
    pub(crate) fn distribution(&self) -> Vec<(f64, f64)> {
        let steps = self.0.iter_quantiles(1);
        steps.map(|step| (step.quantile_iterated_to(), micros(step.value_iterated_to() as f64))).collect()
    }

    /// The parts of all times in so many steps from one time to another, in microseconds; each step is the same factor.
    pub(crate) fn shares(&self, from: f64, to: f64, steps: usize) -> Vec<f64> {
        // A clock may see no time at all, which has no logarithm.
        let [from, to] = [from, to].map(|time| time.max(1e-3).ln());
        let mut counts = vec![0; steps];
        for value in self.0.iter_recorded() {
            let place = (micros(value.value_iterated_to() as f64).max(1e-3).ln() - from) / (to - from);
            // A rounded time may lie just outside, and times that are all the same have no place: saturating will do.
            let step = ((place * steps as f64) as usize).min(steps.saturating_sub(1));
            if let Some(count) = counts.get_mut(step) {
                *count += value.count_at_value();
            }
        }
        counts.into_iter().map(|count| count as f64 / self.0.len() as f64).collect()
    }
}

fn micros(nanoseconds: f64) -> f64 {
    nanoseconds / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_are_in_microseconds() {
        let mut times = Times::new().unwrap();
        for nanoseconds in [1_000, 2_000, 3_000] {
            times.record(nanoseconds);
        }
        let figures = [times.least(), times.quantile(0.5), times.mean(), times.greatest(), times.variance()];
        for (figure, expected) in figures.into_iter().zip([1.0, 2.0, 2.0, 3.0, 2.0 / 3.0]) {
            assert!((figure - expected).abs() < 0.01, "{figures:?}");
        }
        assert_eq!(times.distribution().last().map(|(part, _)| *part), Some(1.0));
    }

    #[test]
    fn shares_are_of_steps_by_a_factor() {
        let mut times = Times::new().unwrap();
        for nanoseconds in [1_000, 2_000, 20_000, 999_000] {
            times.record(nanoseconds);
        }
        assert_eq!(times.shares(1.0, 1000.0, 3), [0.5, 0.25, 0.25]);
        let mut same = Times::new().unwrap();
        same.record(5_000);
        assert_eq!(same.shares(same.least(), same.greatest(), 2).iter().sum::<f64>(), 1.0);
    }
}
