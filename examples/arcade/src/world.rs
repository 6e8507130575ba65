//! The physical world: the airframe with its motors and battery, the air and the ground.
//!
//! x east, y north, z up, in metres and seconds; body axes are x forward, y left, z up.

pub mod battery;
pub mod body;
pub mod ground;
pub mod motors;
pub mod noise;
pub mod wind;

use battery::Battery;
use body::{Body, Load};
use glam::DVec3;
use motors::Motors;
use wind::Wind;

/// Physics steps per second.
pub const RATE: u32 = 1500;
const STEP: f64 = 1.0 / RATE as f64; // s

pub const GRAVITY: f64 = 9.81; // m/s^2
/// Drag for each m/s of air speed, N s/m.
pub const DRAG: f64 = 0.3;
/// Angular drag, mostly of the propellers, N m s.
const ANGULAR_DRAG: f64 = 0.002;

/// The state of the world.
#[derive(Debug)]
pub struct World {
    pub body: Body,
    pub motors: Motors,
    pub battery: Battery,
    pub wind: Wind,
    /// All forces but gravity, divided by the mass, in body axes, m/s^2: what an accelerometer feels.
    pub specific_force: DVec3,
    pub on_ground: bool,
}

impl World {
    /// The vehicle stands at home, facing east.
    pub fn new(wind: Wind, battery: Battery) -> Self {
        let specific_force = DVec3::Z * GRAVITY;
        Self { body: Body::default(), motors: Motors::default(), battery, wind, specific_force, on_ground: true }
    }

    /// Advances by one step with the set-points of the motors.
    pub fn step(&mut self, set_points: [f64; 4]) {
        self.wind.step(STEP);
        let powered = if self.battery.is_empty() { [0.0; 4] } else { set_points };
        self.motors.step(powered, STEP);
        self.battery.draw(self.motors.power(), STEP);

        let air = self.body.velocity - self.wind.at_height(self.body.position.z);
        let drag = Load { force: air * -DRAG, torque: self.body.rates * -ANGULAR_DRAG };
        let thrust = self.motors.load(self.body.attitude);
        let contact = ground::load(&self.body);
        self.on_ground = contact.is_some();
        let load = thrust + drag + contact.unwrap_or_default();
        self.specific_force = self.body.attitude.inverse() * (load.force / body::MASS);
        let weight = Load { force: DVec3::NEG_Z * (GRAVITY * body::MASS), torque: DVec3::ZERO };
        self.body.step(load + weight, STEP);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn still_air() -> World {
        World::new(Wind::new(0.0, 0.0, 1), Battery::new(2.2, 1.0))
    }

    fn run(world: &mut World, seconds: f64, set_points: [f64; 4]) {
        (0..(seconds * f64::from(RATE)).round() as u32).for_each(|_| world.step(set_points));
    }

    #[test]
    fn without_thrust_it_falls_as_galileo_says() {
        let mut world = still_air();
        world.body.position.z = 100.0;
        run(&mut world, 1.0, [0.0; 4]);
        // Drag takes off a little: v = g m / k (1 - exp(-k t / m)).
        let expected = GRAVITY * body::MASS / DRAG * (1.0 - (-DRAG / body::MASS).exp());
        assert!((world.body.velocity.z + expected).abs() < 0.01, "{}", world.body.velocity);
        assert!(world.specific_force.z < DRAG / body::MASS * expected + 0.01);
    }

    #[test]
    fn drag_limits_the_fall() {
        let mut world = still_air();
        world.body.position.z = 5000.0;
        run(&mut world, 40.0, [0.0; 4]);
        assert!((world.body.velocity.z + GRAVITY * body::MASS / DRAG).abs() < 0.02, "{}", world.body.velocity);
    }

    #[test]
    fn it_hovers_where_thrust_is_weight() {
        let mut world = still_air();
        world.body.position.z = 10.0;
        let hover = GRAVITY * body::MASS / (4.0 * motors::MAX_THRUST);
        world.motors = Motors { thrust: [hover * motors::MAX_THRUST; 4] };
        run(&mut world, 5.0, [hover; 4]);
        assert!((world.body.position.z - 10.0).abs() < 0.001, "{}", world.body.position);
        assert!((world.specific_force - DVec3::Z * GRAVITY).length() < 1e-6);
    }

    #[test]
    fn wind_carries_it_along() {
        let mut world = World::new(Wind::new(3.0, 0.0, 1), Battery::new(2.2, 1.0));
        world.body.position.z = 1000.0;
        run(&mut world, 20.0, [0.0; 4]);
        assert!((world.body.velocity.x - 3.0).abs() < 0.05, "{}", world.body.velocity);
    }

    #[test]
    fn it_stands_on_its_feet_also_in_wind() {
        let mut world = World::new(Wind::new(8.0, 2.0, 1), Battery::new(2.2, 1.0));
        run(&mut world, 30.0, [0.0; 4]);
        assert!(world.on_ground && world.body.position.length() < 0.05, "{}", world.body.position);
        assert!((world.specific_force.length() - GRAVITY).abs() < 0.1, "{}", world.specific_force);
    }

    #[test]
    fn an_empty_battery_stops_the_motors() {
        let mut world = World::new(Wind::new(0.0, 0.0, 1), Battery::new(0.01, 1.0));
        run(&mut world, 10.0, [0.5; 4]);
        assert!(world.battery.is_empty());
        assert!(world.motors.thrust.iter().all(|thrust| *thrust < 0.01));
    }
}
