//! How long tests wait, and waiting for what has no event of its own, such as a file that appears or a counter in
//! `/proc`.

use std::thread::park_timeout;
use std::time::{Duration, Instant};

/// How long a test waits for an expected event. Only a test that would hang otherwise ever reaches this limit.
pub const HANG_LIMIT: Duration = Duration::from_secs(300);

/// `SCL_STOP_WITHIN` of programs under test: longer than a test waits, so that none that hangs, or that a busy machine
/// delays, is ended by it.
pub const NEVER: &str = "1000s";

/// Checks a condition again and again until it holds.
///
/// # Panics
/// With `what` if it does not hold within [`HANG_LIMIT`].
#[track_caller]
pub fn wait_until(what: &str, mut condition: impl FnMut() -> bool) {
    wait_for(what, || condition().then_some(()));
}

/// Asks again and again until there is an answer, and returns it.
///
/// # Panics
/// With `what` if there is none within [`HANG_LIMIT`].
#[track_caller]
pub fn wait_for<T>(what: &str, mut ask: impl FnMut() -> Option<T>) -> T {
    let started = Instant::now();
    loop {
        if let Some(answer) = ask() {
            return answer;
        }
        assert!(started.elapsed() < HANG_LIMIT, "still not true: {what}");
        park_timeout(Duration::from_millis(1));
    }
}
