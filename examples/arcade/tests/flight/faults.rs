//! Flights in which something fails.

use crate::aircraft::{Aircraft, wind};
use crate::mission::{SQUARE, STEEPEST};
use arcade::arcade::{Action, Mode};
use arcade::autopilot::parameters::Parameters;
use arcade::autopilot::resume::StateFile;
use arcade::autopilot::state;
use arcade::simulation::{RATE, Settings};
use rand::rngs::StdRng;
use rand::{RngExt, SeedableRng};

/// How long a restart takes, s.
const PAUSE: f64 = 0.15;

#[test]
fn a_restart_in_the_air_is_survived_at_any_moment() {
    for seed in 1..=10 {
        let mut random = StdRng::seed_from_u64(seed);
        let mut aircraft = Aircraft::new(wind(seed));
        aircraft.take_off(5.0);
        for target in SQUARE {
            aircraft.obey(Action::GoTo, target);
            for _ in 0..2 {
                aircraft.run(random.random_range(0.0..3.0));
                aircraft.restart(PAUSE);
            }
            aircraft.reach(target);
            assert!(aircraft.distance_to(target) < 1.0, "seed {seed}: {target:?}, {:?}", aircraft.truth);
        }
        aircraft.obey(Action::Land, [0.0; 3]);
        aircraft.run(random.random_range(0.0..8.0));
        aircraft.restart(PAUSE);
        aircraft.run_until("down", 30.0, |aircraft| aircraft.flight.mode() == Mode::Grounded);
        assert_eq!(aircraft.flight.restarts, 9);
        assert!(aircraft.distance_to([0.0; 3]) < 1.0, "seed {seed}: {:?}", aircraft.truth);
        assert!(aircraft.steepest < STEEPEST, "seed {seed}: {:.1} degrees", aircraft.steepest.to_degrees());
    }
}

#[test]
fn a_restart_while_taking_off_is_survived() {
    for beats in [50, 301, 350, 500, 900] {
        let mut aircraft = Aircraft::new(wind(4));
        aircraft.run(2.0);
        aircraft.obey(Action::TakeOff, [0.0, 0.0, 5.0]);
        aircraft.run(f64::from(beats) / f64::from(RATE));
        aircraft.restart(PAUSE);
        aircraft.run_until("flying", 15.0, |aircraft| aircraft.flight.mode() == Mode::Flying);
        assert!(aircraft.steepest < STEEPEST, "{beats}: {:.1} degrees", aircraft.steepest.to_degrees());
    }
}

#[test]
fn an_old_state_or_one_of_the_ground_is_not_resumed() {
    let mut aircraft = Aircraft::new(wind(1));
    aircraft.run(1.0);
    let on_ground = state::save(aircraft.autopilot());
    aircraft.take_off(5.0);
    let saved = state::save(aircraft.autopilot());
    let time_us = aircraft.autopilot().time_us;
    let resume = |numbers: &[f64], reading_us| {
        state::restore(numbers, Parameters::defaults()).expect("a state").resumed(reading_us)
    };
    assert!(resume(&saved, time_us + 2_000_000).is_some());
    assert!(resume(&saved, time_us + 2_000_001).is_none());
    assert!(resume(&saved, time_us).is_none());
    assert!(resume(&on_ground, 1_100_000).is_none());
}

#[test]
fn the_state_survives_in_its_file() {
    let mut aircraft = Aircraft::new(wind(1));
    aircraft.take_off(5.0);
    aircraft.run(5.0);
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("state");
    let saved = state::save(aircraft.autopilot());
    let (mut file, none) = StateFile::open(&path, state::COUNT).expect("opened");
    assert_eq!(none, None);
    file.store(&saved).expect("stored");
    let (_, numbers) = StateFile::open(&path, state::COUNT).expect("opened");
    let restored = state::restore(&numbers.expect("stored"), Parameters::defaults()).expect("a state");
    assert_eq!(state::save(&restored), saved);
}

#[test]
fn two_seconds_without_gps_do_not_matter() {
    for seed in 1..=5 {
        let mut aircraft = Aircraft::new(wind(seed));
        aircraft.take_off(5.0);
        aircraft.obey(Action::GoTo, SQUARE[0]);
        aircraft.run(2.0);
        aircraft.fixes = false;
        aircraft.run(2.0);
        assert!(aircraft.flight.position_valid);
        aircraft.fixes = true;
        aircraft.reach(SQUARE[0]);
        assert!(aircraft.distance_to(SQUARE[0]) < 1.0, "seed {seed}: {:?}", aircraft.truth);
    }
}

#[test]
fn without_gps_for_long_it_lands() {
    for seed in 1..=3 {
        let mut aircraft = Aircraft::new(wind(seed));
        aircraft.take_off(5.0);
        aircraft.run(5.0);
        aircraft.fixes = false;
        aircraft.run_until("landing", 6.0, |aircraft| aircraft.flight.mode() == Mode::Landing);
        assert!(!aircraft.flight.position_valid);
        aircraft.run_until("down", 30.0, |aircraft| aircraft.flight.mode() == Mode::Grounded);
        assert!(aircraft.truth.on_ground && aircraft.steepest < STEEPEST, "seed {seed}: {:?}", aircraft.truth);
        assert_eq!(aircraft.command(Action::TakeOff, [0.0, 0.0, 5.0]).reason, "no position: waiting for a GPS fix");
    }
}

#[test]
fn when_the_autopilot_does_not_come_back_the_motors_stop() {
    let mut aircraft = Aircraft::new(wind(1));
    aircraft.take_off(5.0);
    aircraft.kill();
    aircraft.run(0.49);
    assert!(aircraft.simulation.world.motors.thrust.iter().all(|thrust| *thrust > 1.0));
    aircraft.run(0.3);
    assert!(aircraft.simulation.world.motors.thrust.iter().all(|thrust| *thrust < 0.1));
}

#[test]
fn commands_out_of_the_fence_are_refused_and_without_effect() {
    let mut aircraft = Aircraft::new(wind(1));
    assert_eq!(aircraft.command(Action::TakeOff, [0.0, 0.0, 5.0]).reason, "no position: waiting for a GPS fix");
    aircraft.take_off(5.0);
    let before = aircraft.flight.command_id;
    let refused = aircraft.command(Action::GoTo, [80.0, 80.0, 5.0]);
    assert_eq!(refused.reason, "target is 113.1 m from home, the fence at 100.0 m");
    assert_eq!(aircraft.command(Action::GoTo, [0.0, 0.0, 31.0]).reason, "height 31.0 m is above the fence at 30.0 m");
    aircraft.run(3.0);
    assert_eq!(aircraft.flight.command_id, before);
    assert!(aircraft.distance_to([0.0, 0.0, 5.0]) < 1.0);
}

#[test]
fn an_empty_battery_ends_the_flight() {
    let mut aircraft = Aircraft::new(Settings { capacity: 0.05, ..wind(1) });
    aircraft.take_off(5.0);
    aircraft.run_until("down", 30.0, |aircraft| aircraft.truth.on_ground);
    assert_eq!(aircraft.truth.charge_left, 0.0);
}
