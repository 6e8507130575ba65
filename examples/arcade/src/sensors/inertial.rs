//! The inertial unit: accelerometers, gyroscopes, and the unit's own angles.

use super::vector;
use crate::arcade::Inertial;
use crate::world::World;
use crate::world::noise::Noise;
use glam::DVec3;

/// White noise of each reading; most of it is vibration.
const ACCELERATION_NOISE: f64 = 0.15; // m/s^2
const RATE_NOISE: f64 = 0.01; // rad/s
const ANGLE_NOISE: f64 = 0.01; // rad
/// Biases, which are constant for a flight.
const ACCELERATION_BIAS: f64 = 0.05; // m/s^2
const RATE_BIAS: f64 = 0.01; // rad/s

/// The unit's errors.
#[derive(Debug)]
pub struct InertialUnit {
    noise: Noise,
    acceleration_bias: DVec3,
    rate_bias: DVec3,
}

impl InertialUnit {
    pub fn new(seed: u64) -> Self {
        let mut noise = Noise::new(seed, "inertial");
        let acceleration_bias = noise.vector(ACCELERATION_BIAS);
        let rate_bias = noise.vector(RATE_BIAS);
        Self { noise, acceleration_bias, rate_bias }
    }

    pub fn measure(&mut self, time_us: u64, world: &World) -> Inertial {
        let noise = &mut self.noise;
        let acceleration = world.specific_force + self.acceleration_bias + noise.vector(ACCELERATION_NOISE);
        let rates = world.body.rates + self.rate_bias + noise.vector(RATE_NOISE);
        let angles = world.body.angles() + noise.vector(ANGLE_NOISE);
        Inertial {
            time_us,
            acceleration: Some(vector(acceleration)),
            rates: Some(vector(rates)),
            angles: Some(vector(angles)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::battery::Battery;
    use crate::world::wind::Wind;
    use glam::DQuat;

    #[test]
    fn the_means_of_many_readings_are_the_truth_and_small_biases() {
        let mut world = World::new(Wind::new(0.0, 0.0, 1), Battery::new(2.2, 1.0));
        world.body.attitude = DQuat::from_rotation_x(0.2);
        world.body.rates = DVec3::new(0.0, 0.5, 0.0);
        let mut unit = InertialUnit::new(4);
        let readings: Vec<_> = (0..10_000).map(|step| unit.measure(step, &world)).collect();
        let mean = |part: fn(&Inertial) -> f64| readings.iter().map(part).sum::<f64>() / 10_000.0;
        assert!((mean(|reading| reading.acceleration.unwrap_or_default().z) - 9.81).abs() < 0.2);
        assert!((mean(|reading| reading.rates.unwrap_or_default().y) - 0.5).abs() < 0.04);
        assert!((mean(|reading| reading.angles.unwrap_or_default().x) - 0.2).abs() < 0.001);
    }
}
