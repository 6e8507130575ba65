//! Events that the simulator reports: take-off, touch-down, motors that stop.

use crate::simulation::Simulation;
use crate::world::motors::HOLD_US;

const TAKEN_OFF: f64 = 0.3; // m
const HARD: f64 = 2.0; // m/s

/// What was reported last.
#[derive(Debug, Default)]
pub struct Watch {
    flying: bool,
    silent: bool,
    empty: bool,
    /// Climb rate at the previous step, m/s.
    climb: f64,
}

impl Watch {
    /// The events of one step, as lines.
    pub fn step(&mut self, simulation: &Simulation) -> Vec<String> {
        let world = &simulation.world;
        let position = world.body.position;
        let time = simulation.time_us() as f64 * 1e-6;
        let mut events = Vec::new();
        if !self.flying && position.z > TAKEN_OFF {
            self.flying = true;
            events.push(format!("{time:.1} s: took off"));
        }
        if self.flying && world.on_ground {
            self.flying = false;
            let distance = position.truncate().length();
            let how = if self.climb < -HARD { "crashed" } else { "touched down" };
            events.push(format!("{time:.1} s: {how} at {:.1} m/s, {distance:.2} m from home", -self.climb));
        }
        self.climb = world.body.velocity.z;
        let silent = simulation.silence_us() > HOLD_US;
        if silent && !self.silent && self.flying {
            events.push(format!("{time:.1} s: no set-points for {} ms, the motors stop", HOLD_US / 1000));
        }
        self.silent = silent;
        if world.battery.is_empty() && !self.empty {
            self.empty = true;
            events.push(format!("{time:.1} s: the battery is empty, the motors stop"));
        }
        events
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcade::Motors;
    use crate::simulation::Settings;

    /// The events while all motors get a set-point, or none.
    fn events(simulation: &mut Simulation, watch: &mut Watch, seconds: u32, set_point: Option<f64>) -> Vec<String> {
        let mut events = Vec::new();
        for _ in 0..seconds * 300 {
            if let Some(x) = set_point {
                let motors = Motors { front_left: x, front_right: x, rear_left: x, rear_right: x, ..Motors::default() };
                simulation.receive(&motors);
            }
            simulation.step();
            events.extend(watch.step(simulation));
        }
        events
    }

    #[test]
    fn a_flight_that_ends_in_a_crash_is_told_in_three_lines() {
        let mut simulation = Simulation::new(&Settings { wind: 0.0, gusts: 0.0, ..Settings::defaults() });
        let mut watch = Watch::default();
        assert!(events(&mut simulation, &mut watch, 1, None).is_empty());
        let up = events(&mut simulation, &mut watch, 2, Some(0.6));
        assert!(up.len() == 1 && up[0].ends_with("s: took off"), "{up:?}");
        let down = events(&mut simulation, &mut watch, 5, None);
        assert_eq!(down.len(), 2, "{down:?}");
        assert!(down[0].ends_with("no set-points for 500 ms, the motors stop"), "{down:?}");
        assert!(down[1].contains("crashed at") && down[1].ends_with("0.00 m from home"), "{down:?}");
    }

    #[test]
    fn an_empty_battery_is_told_once() {
        let mut simulation = Simulation::new(&Settings { capacity: 0.001, ..Settings::defaults() });
        let told = events(&mut simulation, &mut Watch::default(), 5, Some(0.3));
        assert!(told.len() == 1 && told[0].ends_with("the battery is empty, the motors stop"), "{told:?}");
    }
}
