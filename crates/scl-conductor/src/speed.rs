//! Simulations for people who watch: not faster than a multiple of real time.

use std::time::{Duration, Instant};

/// How fast simulated time passes.
#[derive(Debug)]
pub(crate) struct Speed {
    /// Seconds of simulated time in a second; as many as possible if `None`.
    pub(crate) most: Option<f64>,
    /// When the time began to pass, and what it was then.
    began: Option<(Instant, Duration)>,
}

impl Speed {
    pub(crate) fn new(most: Option<f64>) -> Self {
        Self { most, began: None }
    }

    /// Returns how long to wait before simulated time is `next`.
    pub(crate) fn wait(&mut self, now: Duration, next: Duration) -> Duration {
        let Some(most) = self.most else { return Duration::ZERO };
        let (began, start) = *self.began.get_or_insert_with(|| (Instant::now(), now));
        let due = Duration::try_from_secs_f64((next - start).as_secs_f64() / most).unwrap_or(Duration::MAX);
        due.saturating_sub(began.elapsed())
    }
}
