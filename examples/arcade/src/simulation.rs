//! The world in beats of the inertial unit: physics, and the readings that are due.

use crate::arcade::{self, Height, Inertial};
use crate::sensors::height::{self, HeightSensors};
use crate::sensors::inertial::InertialUnit;
use crate::sensors::power::PowerSensor;
use crate::sensors::truth;
use crate::world::battery::Battery;
use crate::world::motors::MotorControllers;
use crate::world::wind::Wind;
use crate::world::{self, World};
use crate::{Simulator, SimulatorParameters};

/// Inertial readings per second; one for each step of the simulation.
pub const RATE: u32 = 300;
const SUBSTEPS: u32 = world::RATE / RATE;
const HEIGHT_PERIOD: u64 = (RATE / height::RATE) as u64; // steps
const BATTERY_PERIOD: u64 = 30; // steps: 10 readings a second
const WORLD_PERIOD: u64 = 6; // steps: 50 a second

/// The settings of a simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Mean wind from the west, m/s.
    pub wind: f64,
    /// Standard deviation of the gusts, m/s.
    pub gusts: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Capacity of the battery, Ah.
    pub capacity: f64,
    /// Charge of the battery at the start, 0 to 1.
    pub charge: f64,
}

impl Settings {
    /// Those of the simulator's parameters.
    pub fn new(parameters: &SimulatorParameters) -> Self {
        let SimulatorParameters { wind, gusts, seed, capacity, charge, .. } = *parameters;
        Self { wind, gusts, seed, capacity, charge }
    }

    /// The defaults of the topology, for tests.
    ///
    /// # Panics
    /// Panics if the simulator cannot be opened for a test.
    pub fn defaults() -> Self {
        let (simulator, _peer) = Simulator::test_blocking().expect("opened");
        Self::new(&simulator.parameters)
    }
}

/// The readings of one step. Not every sensor has a reading in each step.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    pub inertial: Inertial,
    pub height: Option<Height>,
    pub battery: Option<arcade::Battery>,
    pub world: Option<arcade::World>,
}

/// World and sensors.
#[derive(Debug)]
pub struct Simulation {
    pub world: World,
    controllers: MotorControllers,
    inertial: InertialUnit,
    height: HeightSensors,
    power: PowerSensor,
    steps: u64,
}

impl Simulation {
    pub fn new(settings: &Settings) -> Self {
        let seed = settings.seed;
        Self {
            world: World::new(
                Wind::new(settings.wind, settings.gusts, seed),
                Battery::new(settings.capacity, settings.charge),
            ),
            controllers: MotorControllers::default(),
            inertial: InertialUnit::new(seed),
            height: HeightSensors::new(seed),
            power: PowerSensor::new(seed),
            steps: 0,
        }
    }

    /// The vehicle's clock.
    pub fn time_us(&self) -> u64 {
        self.steps * 1_000_000 / u64::from(RATE)
    }

    /// Number of steps so far.
    pub fn steps(&self) -> u64 {
        self.steps
    }

    /// Microseconds since the last set-points for the motors.
    pub fn silence_us(&self) -> u64 {
        self.controllers.silence_us(self.time_us())
    }

    /// Takes set-points for the motors.
    pub fn receive(&mut self, motors: &arcade::Motors) {
        let set_points = [motors.front_left, motors.front_right, motors.rear_left, motors.rear_right];
        self.controllers.receive(set_points, self.time_us());
    }

    /// Advances by one inertial reading.
    pub fn step(&mut self) -> Readings {
        let set_points = self.controllers.set_points(self.time_us());
        (0..SUBSTEPS).for_each(|_| self.world.step(set_points));
        self.steps += 1;
        let (time_us, world) = (self.time_us(), &self.world);
        let due = |period| self.steps.is_multiple_of(period);
        Readings {
            inertial: self.inertial.measure(time_us, world),
            height: due(HEIGHT_PERIOD).then(|| self.height.measure(time_us, world)),
            battery: due(BATTERY_PERIOD).then(|| self.power.measure(time_us, &world.battery)),
            world: due(WORLD_PERIOD).then(|| truth(time_us, world)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_sensor_has_its_rate() {
        let mut simulation = Simulation::new(&Settings::defaults());
        let readings: Vec<_> = (0..300).map(|_| simulation.step()).collect();
        assert_eq!(readings.iter().filter(|readings| readings.height.is_some()).count(), 20);
        assert_eq!(readings.iter().filter(|readings| readings.battery.is_some()).count(), 10);
        assert_eq!(readings.iter().filter(|readings| readings.world.is_some()).count(), 50);
        assert_eq!(readings[299].inertial.time_us, 1_000_000);
    }

    #[test]
    fn the_same_seed_gives_the_same_readings() {
        let run = |seed| {
            let mut simulation = Simulation::new(&Settings { seed, ..Settings::defaults() });
            (0..100).map(|_| simulation.step()).collect::<Vec<_>>()
        };
        assert_eq!(run(5), run(5));
        assert_ne!(run(5), run(6));
    }
}
