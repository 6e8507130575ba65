//! Detects tokio's paused clock.

/// Returns true while tokio's clock is paused, which only tests can do.
///
/// Tokio does not expose this, but its paused clock stands still while the operating system's advances. Takes four
/// readings of the clock, about 0.1 us.
pub(super) fn is_paused() -> bool {
    let before = tokio::time::Instant::now();
    let start = std::time::Instant::now();
    while std::time::Instant::now() <= start {}
    // Unless paused, tokio's clock advances with the system's, which has advanced since `start`.
    tokio::time::Instant::now() == before
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;
    use tokio::time::{advance, pause, resume};

    #[tokio::test]
    async fn a_pause_is_seen_as_long_as_it_lasts() {
        for _ in 0..1000 {
            assert!(!is_paused());
            pause();
            assert!(is_paused());
            advance(Duration::from_millis(1)).await;
            assert!(is_paused());
            resume();
        }
    }

    #[test]
    fn outside_a_runtime_nothing_is_paused() {
        assert!(!is_paused());
    }
}
