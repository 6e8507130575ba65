//! Ticks by the operating system's clock and by tokio's paused one.

use super::*;
use tokio::time::{advance, pause, resume};

/// What the closure makes in the context of a runtime that has ended when this returns.
pub(super) fn in_a_runtime_that_ends<T>(make: impl FnOnce() -> T) -> T {
    let runtime = tokio::runtime::Builder::new_current_thread().enable_all().build().unwrap();
    let _entered = runtime.enter();
    make()
}

#[tokio::test]
async fn missed_ticks_are_counted_and_can_be_skipped() {
    const PERIOD: Duration = Duration::from_millis(2);
    let ticks_since = |start: std::time::Instant| start.elapsed().as_nanos() / PERIOD.as_nanos();
    let before = std::time::Instant::now();
    let mut tick = interval(PERIOD).unwrap();
    let after = std::time::Instant::now();
    tick.tick().await.unwrap();
    while ticks_since(after) < 10 {}
    tick.tick().await.unwrap();
    let at_least = ticks_since(after);
    let ticks = 2 + u128::from(tick.skip_missed());
    assert!((at_least..=ticks_since(before)).contains(&ticks), "{ticks} ticks, not {at_least} or a few more");
    tick.tick().await.unwrap();
    assert!(ticks_since(before) > ticks, "a tick came before its time, or twice");
}

#[tokio::test]
async fn a_period_of_zero_is_refused() {
    let error = interval(Duration::ZERO).unwrap_err();
    assert_eq!(error.to_string(), "the period of an interval must not be zero");
}

#[test]
fn an_interval_outside_a_runtime_is_refused() {
    let error = interval(Duration::from_secs(1)).unwrap_err();
    assert!(error.to_string().starts_with("an interval needs a tokio runtime"), "{error}");
}

#[tokio::test(flavor = "current_thread")]
async fn an_interval_whose_runtime_has_ended_is_an_error() {
    let ended = std::thread::spawn(|| in_a_runtime_that_ends(|| interval(Duration::from_secs(1)).unwrap()));
    let mut tick = ended.join().unwrap();
    tick.tick().await.unwrap_err();
}

#[tokio::test(start_paused = true)]
async fn a_thousand_ticks_by_the_paused_clock_take_no_time() {
    const PERIOD: Duration = Duration::from_secs(60);
    let start = Instant::now();
    let mut tick = interval(PERIOD).unwrap();
    for count in 1..=1000 {
        tick.tick().await.unwrap();
        assert_eq!(start.elapsed(), PERIOD * count);
    }
}

#[tokio::test(start_paused = true)]
async fn ticks_of_less_than_a_millisecond_come_several_at_a_time_by_the_paused_clock() {
    const PERIOD: Duration = Duration::from_micros(100);
    let start = Instant::now();
    let mut tick = interval(PERIOD).unwrap();
    for count in 1..=1000 {
        tick.tick().await.unwrap();
        let late = start.elapsed().checked_sub(PERIOD * count).expect("no tick before its time");
        assert!(late < Duration::from_millis(1), "tick {count} is late by {late:?}");
    }
}

#[tokio::test(start_paused = true)]
async fn missed_ticks_are_counted_by_the_paused_clock() {
    let start = Instant::now();
    let mut tick = interval(Duration::from_millis(10)).unwrap();
    let elapsed = || start.elapsed().as_millis();
    assert_eq!(tick.skip_missed(), 0);
    advance(Duration::from_millis(35)).await;
    for _ in 0..3 {
        tick.tick().await.unwrap();
        assert_eq!(elapsed(), 35);
    }
    tick.tick().await.unwrap();
    assert_eq!(elapsed(), 40);
    advance(Duration::from_millis(10)).await;
    assert_eq!(tick.skip_missed(), 1);
    assert_eq!(tick.skip_missed(), 0);
    advance(Duration::from_millis(35)).await;
    tick.tick().await.unwrap();
    assert_eq!((tick.skip_missed(), elapsed()), (2, 85));
    tick.tick().await.unwrap();
    assert_eq!(elapsed(), 90);
}

#[tokio::test(start_paused = true)]
async fn a_tick_is_not_lost_by_a_cancelled_wait() {
    let start = Instant::now();
    let mut tick = interval(Duration::from_millis(10)).unwrap();
    tokio::time::timeout(Duration::from_millis(9), tick.tick()).await.unwrap_err();
    tick.tick().await.unwrap();
    assert_eq!(start.elapsed().as_millis(), 10);
}

#[tokio::test]
async fn the_clock_may_be_paused_and_resumed() {
    const PERIOD: Duration = Duration::from_millis(1);
    let mut tick = interval(PERIOD).unwrap();
    for _ in 0..3 {
        tick.tick().await.unwrap();
        pause();
        let paused = Instant::now();
        for count in 1..=1000 {
            tick.tick().await.unwrap();
            assert!(paused.elapsed() >= PERIOD * count);
        }
        resume();
        let resumed = std::time::Instant::now();
        tick.tick().await.unwrap();
        assert!(resumed.elapsed() >= PERIOD, "a tick came before its time");
    }
}
