//! The outcome depends on the times in messages, not on when they arrive.

use crate::aircraft::{Aircraft, wind};
use arcade::arcade::Action;

const TARGET: [f64; 3] = [5.0, 5.0, 4.0];

/// A short flight, with messages that arrive some beats late.
fn flight(latency: u64) -> Aircraft {
    let mut aircraft = Aircraft::new(wind(3));
    aircraft.latency = latency;
    aircraft.take_off(7.0);
    aircraft.obey(Action::GoTo, TARGET);
    aircraft.run(6.0);
    aircraft
}

#[test]
fn messages_within_the_delay_give_the_same_set_points() {
    let in_time = flight(0);
    for latency in [1, 3, 5] {
        assert!(flight(latency).motors == in_time.motors, "{latency} beats late");
    }
}

#[test]
fn later_messages_still_fly() {
    // 100 ms: heights and fixes are late.
    let late = flight(30);
    assert!(late.motors != flight(0).motors);
    assert!(late.distance_to(TARGET) < 1.0, "{:?}", late.truth);
}
