//! Flights without faults, in wind.

use crate::aircraft::{Aircraft, wind};
use arcade::arcade::{Action, Mode};
use arcade::simulation::Settings;

/// A square with sides of 15 m at several heights.
pub(crate) const SQUARE: [[f64; 3]; 4] = [[15.0, 0.0, 5.0], [15.0, 15.0, 8.0], [0.0, 15.0, 6.0], [0.0, 0.0, 5.0]];

/// Steeper means that the controllers are at their limits, rad.
pub(crate) const STEEPEST: f64 = 35.0 * std::f64::consts::PI / 180.0;

#[test]
fn it_holds_its_height() {
    for seed in 1..=5 {
        let mut aircraft = Aircraft::new(wind(seed));
        aircraft.take_off(5.0);
        aircraft.run(3.0);
        for _ in 0..10 {
            aircraft.run(1.0);
            let position = aircraft.truth.position.expect("a position");
            assert!((position.z - 5.0).abs() < 0.3, "seed {seed}: {position:?}");
            assert!(position.x.hypot(position.y) < 1.0, "seed {seed}: {position:?}");
        }
    }
}

#[test]
fn it_flies_a_square_and_lands_at_home() {
    for seed in 1..=10 {
        let mut aircraft = Aircraft::new(wind(seed));
        aircraft.take_off(5.0);
        for target in SQUARE {
            aircraft.fly_to(target);
            assert!(aircraft.distance_to(target) < 1.0, "seed {seed}: {target:?}, {:?}", aircraft.truth);
        }
        aircraft.land();
        assert!(aircraft.distance_to([0.0; 3]) < 1.0, "seed {seed}: {:?}", aircraft.truth);
        assert!(aircraft.steepest < STEEPEST, "seed {seed}: {:.1} degrees", aircraft.steepest.to_degrees());
        assert!(aircraft.truth.on_ground && aircraft.flight.mode() == Mode::Grounded);
    }
}

#[test]
fn a_strong_wind_does_not_carry_it_away() {
    let mut aircraft = Aircraft::new(Settings { wind: 9.0, gusts: 1.5, ..Settings::defaults() });
    aircraft.take_off(5.0);
    aircraft.fly_to([-10.0, 5.0, 10.0]);
    assert!(aircraft.distance_to([-10.0, 5.0, 10.0]) < 1.0, "{:?}", aircraft.truth);
    aircraft.land();
    assert!(aircraft.distance_to([-10.0, 5.0, 0.0]) < 1.0, "{:?}", aircraft.truth);
}

#[test]
fn it_turns_to_the_yaw_of_the_command() {
    let mut aircraft = Aircraft::new(wind(1));
    aircraft.take_off(5.0);
    aircraft.go_to([0.0, 0.0, 5.0], 2.5, 0.0);
    aircraft.run(5.0);
    let yaw = aircraft.truth.attitude.expect("an attitude").z;
    assert!((yaw - 2.5).abs() < 0.05, "{yaw}");
    assert!(aircraft.distance_to([0.0, 0.0, 5.0]) < 1.0, "{:?}", aircraft.truth);
}

#[test]
fn it_keeps_to_the_speed_of_the_command() {
    let mut aircraft = Aircraft::new(Settings { gusts: 0.0, ..wind(1) });
    aircraft.take_off(5.0);
    aircraft.go_to([20.0, 0.0, 5.0], 0.0, 1.0);
    let mut fastest: f64 = 0.0;
    for _ in 0..60 {
        aircraft.run(0.1);
        fastest = fastest.max(aircraft.truth.velocity.expect("a velocity").x);
    }
    assert!((0.9..1.3).contains(&fastest), "{fastest}");
}

#[test]
fn a_new_command_replaces_the_one_in_effect() {
    let mut aircraft = Aircraft::new(wind(2));
    aircraft.take_off(5.0);
    aircraft.obey(Action::GoTo, [40.0, 0.0, 5.0]);
    aircraft.run(3.0);
    aircraft.fly_to([0.0, 10.0, 5.0]);
    aircraft.obey(Action::GoTo, [0.0, -40.0, 5.0]);
    aircraft.run(4.0);
    let before = aircraft.truth.position.expect("a position");
    aircraft.land();
    let after = aircraft.truth.position.expect("a position");
    assert!((after.x - before.x).hypot(after.y - before.y) < 5.0, "from {before:?} to {after:?}");
    assert!(aircraft.steepest < STEEPEST, "{:.1} degrees", aircraft.steepest.to_degrees());
}

#[test]
fn it_lands_only_on_the_ground() {
    // Vertical gusts must not be taken for the ground, nor a slow descent for standing.
    for seed in 1..=5 {
        let mut aircraft = Aircraft::new(Settings { gusts: 2.0, ..wind(seed) });
        aircraft.take_off(8.0);
        aircraft.obey(Action::Land, [0.0; 3]);
        aircraft.run_until("down", 30.0, |aircraft| aircraft.flight.mode() == Mode::Grounded);
        assert!(aircraft.truth.on_ground, "seed {seed}: {:?}", aircraft.truth);
    }
}
