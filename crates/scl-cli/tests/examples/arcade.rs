//! Flights of `examples/arcade`, in real time, checked by what is true of the simulated world.
//!
//! They leave recordings and figures in `target/examples/arcade`. For figures that mean something:
//! `EXAMPLES_PROFILE=release cargo test -p scl-cli --test examples arcade -- --nocapture`.

mod checks;
mod flight;
mod periods;
mod recording;
mod replay;

use crate::aircraft::arcade::{Arbitration, Authority};
use crate::{built, lock_machine};
use checks::waypoints;
use flight::{Flight, Flown, Position};
use periods::Periods;
use serde_json::{Value, json};
use std::process::{Command, Stdio};

/// The parts of Figure 6 and when each is killed: at which step of the survey, this far from its target, in metres.
const KILLS: [(u64, f64, &str); 8] = [
    (100, 3.0, "configuration"),
    (101, 10.0, "blackbox"),
    (102, 12.0, "gps_sensor"),
    (102, 5.0, "power_management"),
    (103, 10.0, "autopilot"),
    (104, f64::INFINITY, "uav_mission"),
    (105, 8.0, "mission_arbiter"),
    (106, 4.0, "communication"),
];

/// Judged by what happens, not by how fast, so it also holds on a busy machine.
#[test]
fn a_short_hop_is_flown() {
    let _machine = lock_machine();
    let mut flight = Flight::start("short", &["--profile", "hop", "--profile", "calm"]);
    assert_eq!(flight.fly(|_, _| {}), "ended with exit code 0", "{}", flight.log);
    let flown = flight.end();
    flown.recording.check_waypoints(&waypoints("hop.yaml"));
    flown.recording.check_landing();
    assert_eq!(flown.code, Some(0), "{}", flown.log);
}

#[test]
fn a_survey_is_flown() {
    let _machine = lock_machine();
    let mut flight = Flight::start("survey", &[]);
    let timer = Timer::start(&mut flight, "survey");
    assert_eq!(flight.fly(|_, _| {}), "ended with exit code 0", "{}", flight.log);
    let flown = flight.end();
    flown.check("survey.yaml");
    flown.recording.check_beats(0);
    assert!(!flown.log.contains("restarting"), "{}", flown.log);
    timer.report(&flown);
}

#[test]
fn every_part_is_killed_once_and_the_flight_goes_on() {
    let _machine = lock_machine();
    let mut flight = Flight::start("kills", &[]);
    let timer = Timer::start(&mut flight, "kills");
    let mut kills: Vec<Value> = Vec::new();
    let ending = flight.fly(|flight, position| {
        if let Some(&(step, distance, component)) = KILLS.get(kills.len())
            && is_past(position, step, distance)
        {
            flight.kill(component);
            println!("killed {component} at {:.1} s", position.time_us as f64 / 1e6);
            kills.push(json!({"component": component, "time_us": position.time_us}));
        }
    });
    assert_eq!(ending, "ended with exit code 0", "{}", flight.log);
    assert_eq!(kills.len(), KILLS.len(), "{kills:?}\n{}", flight.log);
    for (_, _, component) in KILLS {
        assert_eq!(flight.process_id(component).is_some(), component != "uav_mission", "{component}\n{}", flight.log);
    }
    let flown = flight.end();
    flown.check("survey.yaml");
    for (_, _, component) in KILLS {
        let line = format!("`{component}` was restarted once; last reason: killed by signal 9 (SIGKILL)");
        assert!(flown.log.contains(&line), "{component}\n{}", flown.log);
    }
    let pauses = flown.recording.check_beats(1);
    println!("readings without a beat while the autopilot was started again: {}", pauses[0]);
    assert_eq!(flown.recording.flight.last().unwrap().restarts, 1);
    write_json("kills", &Value::Array(kills));
    timer.report(&flown);
}

#[test]
fn with_little_charge_the_arbiter_brings_the_aircraft_home() {
    let _machine = lock_machine();
    let mut flight = Flight::start("low-battery", &["--profile", "low-battery"]);
    let ending = flight.fly(|_, _| {});
    flight.land();
    let flown = flight.end();
    assert_eq!(ending, "ended with exit code 1", "{}", flown.log);
    flown.recording.check_landing();
    flown.recording.check_attitude();
    flown.recording.check_beats(0);
    let is_safety = |arbitration: &&Arbitration| arbitration.authority() == Authority::Safety;
    let decided = flown.recording.arbitration.iter().find(is_safety);
    assert!(decided.is_some_and(|it| it.reason.starts_with("low power")), "{decided:?}\n{}", flown.log);
    // The mission has failed, but nothing else.
    assert!(flown.log.contains("scl: non-essential component `uav_mission` failed"), "{}", flown.log);
    assert_eq!(flown.code, Some(0), "{}", flown.log);
}

#[test]
fn twins_take_the_places_of_autopilot_and_gps_sensor_and_the_autopilot_in_c_repeats_their_flight() {
    let _machine = lock_machine();
    let mut flight = Flight::start("twins", &["--profile", "rust-autopilot", "--profile", "nmea", "--profile", "hop"]);
    assert_eq!(flight.fly(|_, _| {}), "ended with exit code 0", "{}", flight.log);
    flight.end().check("hop.yaml");
    replay::check("twins");
}

/// A later step of the mission is past every distance.
fn is_past(position: &Position, step: u64, distance: f64) -> bool {
    position.command_id > step || (position.command_id == step && position.distance <= distance)
}

impl Flown {
    /// All waypoints of the mission, and a landing at home.
    #[track_caller]
    fn check(&self, mission: &str) {
        self.recording.check_waypoints(&waypoints(mission));
        self.recording.check_landing();
        self.recording.check_attitude();
        assert_eq!(self.code, Some(0), "{}", self.log);
    }
}

/// A bare timer loop beside the flight: what the machine itself can do.
struct Timer {
    name: &'static str,
    times: std::path::PathBuf,
}

impl Timer {
    fn start(flight: &mut Flight, name: &'static str) -> Self {
        let times = built("arcade").join(format!("{name}-timer.txt"));
        let mut command = Command::new(built("arcade").join("c/timer"));
        command.stdout(std::fs::File::create(&times).unwrap()).stderr(Stdio::null());
        flight.start_beside(command);
        Self { name, times }
    }

    /// Prints and writes the figures of both loops.
    fn report(self, flown: &Flown) {
        let times = std::fs::read_to_string(&self.times).unwrap();
        let times: Vec<u64> = times.lines().map(|line| line.parse().unwrap()).collect();
        let (autopilot, timer) = (Periods::of(&flown.recording.beats), Periods::between(&times));
        println!("{}: autopilot, {autopilot}", self.name);
        println!("{}: bare timer, {timer}", self.name);
        let figures = json!({"autopilot": autopilot.to_json(), "timer": timer.to_json()});
        write_json(&format!("{}-periods", self.name), &figures);
    }
}

fn write_json(name: &str, value: &Value) {
    let text = serde_json::to_string_pretty(value).unwrap() + "\n";
    std::fs::write(built("arcade").join(name).with_extension("json"), text).unwrap();
}
