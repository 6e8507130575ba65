//! Times in a histogram of three digits.

use hdrhistogram::Histogram;

/// A minute; longer times count as this one, in nanoseconds.
const LONGEST: u64 = 60_000_000_000;

/// The times of one way of doing something, in nanoseconds.
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
}
