//! What is true of a good flight, in numbers.

use super::recording::{Numbered, Recording};
use crate::aircraft::arcade::{Vector, World};
use crate::example;

/// A waypoint of a mission: the id of its command, and metres east, north and up.
#[derive(Debug, PartialEq)]
pub(super) struct Waypoint {
    command_id: u32,
    position: [f64; 3],
}

/// The steps `go_to: {east: 15, north: 0, height: 5}` of a mission script.
pub(super) fn waypoints(mission: &str) -> Vec<Waypoint> {
    let script = std::fs::read_to_string(example("arcade").join("missions").join(mission)).unwrap();
    waypoints_of(&script)
}

fn waypoints_of(script: &str) -> Vec<Waypoint> {
    let steps = script.lines().filter_map(|line| line.trim_start().strip_prefix("- "));
    let numbered = (100..).zip(steps);
    let waypoint = |(command_id, step): (u32, &str)| {
        let values = step.strip_prefix("go_to:")?;
        let value = |name: &str| {
            let (_, rest) = values.split_once(&format!("{name}:"))?;
            rest.trim_start().split([',', '}', ' ']).next()?.parse().ok()
        };
        let position = ["east", "north", "height"].map(|name| value(name).unwrap());
        Some(Waypoint { command_id, position })
    };
    numbered.filter_map(waypoint).collect()
}

impl Recording {
    /// The vehicle is within a metre of each waypoint when the mission goes on to the next.
    #[track_caller]
    pub(super) fn check_waypoints(&self, waypoints: &[Waypoint]) {
        assert!(!waypoints.is_empty());
        for waypoint in waypoints {
            let last = self.flight.iter().rfind(|flight| flight.command_id == waypoint.command_id);
            let last = last.unwrap_or_else(|| panic!("{waypoint:?} was never the target"));
            let missed_by = distance(position(self.world_at(last.time_us)), waypoint.position);
            println!("{waypoint:?} missed by {missed_by:.2} m");
            assert!(missed_by <= 1.0, "{waypoint:?} missed by {missed_by:.2} m");
        }
    }

    /// It was in the air and stands within a metre of home with its motors off.
    #[track_caller]
    pub(super) fn check_landing(&self) {
        self.check_on_ground();
        let [east, north, _] = position(self.world.last().unwrap());
        println!("landed {:.2} m from home", east.hypot(north));
        assert!(east.hypot(north) <= 1.0, "landed {:.2} m from home", east.hypot(north));
    }

    /// It was in the air and stands on the ground.
    #[track_caller]
    pub(super) fn check_on_ground(&self) {
        let highest = self.world.iter().map(|world| position(world)[2]).fold(0.0, f64::max);
        assert!(highest > 2.0, "it only reached a height of {highest} m");
        let last = self.world.last().unwrap();
        assert!(last.on_ground, "{last:?}");
    }

    /// Roll and pitch stay below 35 degrees.
    #[track_caller]
    pub(super) fn check_attitude(&self) {
        let angles = self.world.iter().flat_map(|world| {
            let attitude = world.attitude.unwrap_or_default();
            [attitude.x.abs(), attitude.y.abs()]
        });
        let largest = angles.fold(0.0, f64::max).to_degrees();
        println!("largest roll or pitch: {largest:.1} degrees");
        assert!(largest <= 35.0, "roll or pitch of {largest:.1} degrees");
    }

    /// Each inertial reading has its beat, except while the autopilot is started again this often. Returns how many
    /// have none then.
    #[track_caller]
    pub(super) fn check_beats(&self, restarts: usize) -> Vec<u64> {
        let period_us = 1e6 / 300.0;
        let mut pauses = Vec::new();
        for pair in self.beats.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            let elapsed_us = (after.beat.time_us - before.beat.time_us) as f64;
            if after.number > before.number {
                let beats = f64::from(after.number - before.number);
                assert!((elapsed_us - beats * period_us).abs() < period_us / 2.0, "{}", missing(before, after));
            } else {
                // A recorder needs a moment to find a new process, but the number tells how many beats that had.
                let readings = (elapsed_us / period_us).round() as u64;
                pauses.push(readings - 1 - u64::from(after.number));
            }
        }
        assert_eq!(pauses.len(), restarts, "pauses: {pauses:?}");
        let [first, last] = [self.readings.first(), self.readings.last()].map(|time| *time.unwrap());
        let [first_beat, last_beat] = [self.beats.first(), self.beats.last()].map(|it| it.unwrap().beat.time_us);
        let [early, late] = [first_beat.abs_diff(first), last.abs_diff(last_beat)];
        // At both ends, the programs and the recorder do not start and stop at the same moment.
        assert!(
            early < 1_000_000 && late < 1_000_000,
            "beats from {first_beat} to {last_beat} us of {first} to {last}"
        );
        pauses
    }
}

fn missing(before: Numbered, after: Numbered) -> String {
    let [from, to] = [before, after].map(|it| format!("beat {} at {} us", it.number, it.beat.time_us));
    format!("readings without a beat between {from} and {to}")
}

fn position(world: &World) -> [f64; 3] {
    let Vector { x, y, z } = world.position.unwrap_or_default();
    [x, y, z]
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn waypoints_have_the_numbers_of_their_steps() {
    let script = "\
name: short
steps:
  - take_off: {height: 5}
  - go_to: {east: 10, north: -2.5, height: 5, speed: 3}
  - hold: 3s
  - go_to: {height: 6, east: 0, north: 1}
";
    let waypoint = |command_id, position| Waypoint { command_id, position };
    assert_eq!(waypoints_of(script), [waypoint(101, [10.0, -2.5, 5.0]), waypoint(103, [0.0, 1.0, 6.0])]);
}
