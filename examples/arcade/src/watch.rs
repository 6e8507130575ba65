//! What is worth a line: take-off, touch-down, motors that stop.

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
    /// Of the step before, m/s.
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
