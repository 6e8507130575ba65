//! Times as a table: ours, the raw part's, and their ratio.

use hdrhistogram::Histogram;
use std::time::Duration;

/// The times of one way of doing something.
pub(crate) struct Figures {
    name: &'static str,
    times: Histogram<u64>,
}

impl Figures {
    pub(crate) fn of(name: &'static str) -> Self {
        let times = Histogram::new(3).expect("three digits are within the histogram's range");
        Self { name, times }
    }

    pub(crate) fn record(&mut self, time: Duration) {
        self.times.saturating_record(time.as_nanos().try_into().unwrap_or(u64::MAX));
    }

    fn micros(&self, quantile: f64) -> f64 {
        self.times.value_at_quantile(quantile) as f64 / 1e3
    }
}

/// Prints rows of `[ours, raw]`.
pub(crate) fn print(title: &str, pairs: &[[Figures; 2]]) {
    println!("{title}");
    println!("{:24} {:>10} {:>10} {:>10} {:>10}", "", "p50 us", "p99 us", "p50 ratio", "p99 ratio");
    for [ours, raw] in pairs {
        let ratio = |quantile| ours.micros(quantile) / raw.micros(quantile);
        let (p50, p99) = (ratio(0.5), ratio(0.99));
        println!("{:24} {:10.2} {:10.2} {p50:10.2} {p99:10.2}", ours.name, ours.micros(0.5), ours.micros(0.99));
        println!("{:24} {:10.2} {:10.2}", raw.name, raw.micros(0.5), raw.micros(0.99));
    }
}
