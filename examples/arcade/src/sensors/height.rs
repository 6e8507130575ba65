//! The height sensors: ultrasonic near the ground, and a barometer.

use crate::arcade::Height;
use crate::arcade::height::Range;
use crate::world::World;
use crate::world::noise::{Noise, Wander};
use glam::DVec3;

const ULTRASONIC_RANGE: f64 = 6.0; // m
const ULTRASONIC_NOISE: f64 = 0.02; // m
/// Tilted further than this, the echo misses the sensor; cosine of 25 degrees.
const ULTRASONIC_UPRIGHT: f64 = 0.906;
const BAROMETER_NOISE: f64 = 0.1; // m
/// The barometer drifts with the weather.
const BAROMETER_DRIFT: f64 = 0.3; // m
const BAROMETER_DRIFT_TIME: f64 = 120.0; // s
/// Readings per second.
pub const RATE: u32 = 20;

/// The sensors' errors.
#[derive(Debug)]
pub struct HeightSensors {
    noise: Noise,
    drift: Wander,
}

impl HeightSensors {
    pub fn new(seed: u64) -> Self {
        Self { noise: Noise::new(seed, "height"), drift: Wander::new(BAROMETER_DRIFT, BAROMETER_DRIFT_TIME) }
    }

    pub fn measure(&mut self, time_us: u64, world: &World) -> Height {
        self.drift.step(&mut self.noise, 1.0 / f64::from(RATE));
        let height = world.body.position.z;
        let upright = (world.body.attitude * DVec3::Z).z;
        let range = (height / upright + self.noise.normal(ULTRASONIC_NOISE)).max(0.0);
        let heard = upright > ULTRASONIC_UPRIGHT && range <= ULTRASONIC_RANGE;
        let barometer = height + self.drift.value + self.noise.normal(BAROMETER_NOISE);
        Height { time_us, range: heard.then_some(Range::Ultrasonic(range)), barometer }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::battery::Battery;
    use crate::world::wind::Wind;
    use glam::DQuat;

    fn measured(height: f64, tilt: f64) -> Height {
        let mut world = World::new(Wind::new(0.0, 0.0, 1), Battery::new(2.2, 1.0));
        world.body.position.z = height;
        world.body.attitude = DQuat::from_rotation_x(tilt);
        HeightSensors::new(1).measure(7, &world)
    }

    #[test]
    fn the_ultrasonic_sensor_measures_along_its_axis() {
        let Some(Range::Ultrasonic(range)) = measured(3.0, 0.2).range else { panic!("no echo") };
        assert!((range - 3.0 / 0.2f64.cos()).abs() < 0.1, "{range}");
    }

    #[test]
    fn it_is_absent_when_too_high_or_too_tilted() {
        assert_eq!(measured(6.2, 0.0).range, None);
        assert_eq!(measured(3.0, 0.6).range, None);
        assert!((measured(8.0, 0.0).barometer - 8.0).abs() < 0.5);
    }
}
