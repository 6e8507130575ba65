//! Flights of `examples/arcade`, in simulated and in real time, checked by what is true of the simulated world.
//!
//! They leave recordings and figures in `target/examples/arcade`. For figures that mean something:
//! `EXAMPLES_PROFILE=release cargo test -p scl-cli --test examples arcade -- --nocapture`.

mod checks;
mod flight;
mod periods;
mod recording;
mod simulated;

use crate::{built, lock_machine};
use checks::waypoints;
use flight::{Flight, Flown};
use periods::Periods;
use serde_json::{Value, json};
use std::process::{Command, Stdio};

/// Judged by what happens, not by how fast, so it also holds on a busy machine.
#[test]
fn a_short_hop_is_flown() {
    let _machine = lock_machine();
    let mut flight = Flight::start("short", &["--profile", "hop", "--profile", "calm"]);
    assert_eq!(flight.fly(), "ended with exit code 0", "{}", flight.log);
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
    assert_eq!(flight.fly(), "ended with exit code 0", "{}", flight.log);
    let flown = flight.end();
    flown.check("survey.yaml");
    flown.recording.check_beats(0);
    assert!(!flown.log.contains("restarting"), "{}", flown.log);
    timer.report(&flown);
}

#[test]
fn twins_take_the_places_of_autopilot_and_gps_sensor() {
    let _machine = lock_machine();
    let mut flight = Flight::start("twins", &["--profile", "rust-autopilot", "--profile", "nmea", "--profile", "hop"]);
    assert_eq!(flight.fly(), "ended with exit code 0", "{}", flight.log);
    flight.end().check("hop.yaml");
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
