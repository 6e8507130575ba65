//! A GPS receiver: what it measures of the true position, with its errors.
//!
//! In the system this is the program `gps_sensor`; the simulator needs it for its serial port, and tests for their
//! flights.

use crate::arcade::{self, Fix, FixQuality};
use crate::geodesy::{self, Home};
use crate::world::noise::{Noise, Wander};

/// Errors of each fix, and errors that wander with the satellites and the ionosphere (Groves, section 9.3).
const WHITE: f64 = 0.15; // m
const SLOW: f64 = 0.15; // m
const SLOW_TIME: f64 = 30.0; // s
/// Factor of the errors of heights, which are larger because all satellites are above.
const HEIGHT_WORSE: f64 = 1.5;
const SPEED_WHITE: f64 = 0.05; // m/s, by Doppler shift
/// Fixes per second.
pub const RATE: u32 = 5;
const SATELLITES: u32 = 10;

/// The receiver's errors.
#[derive(Debug)]
pub struct Receiver {
    noise: Noise,
    drift: [Wander; 3],
}

impl Receiver {
    pub fn new(seed: u64) -> Self {
        let mut noise = Noise::new(seed, "gps");
        let mut drift = [Wander::new(SLOW, SLOW_TIME); 3];
        drift.iter_mut().for_each(|drift| drift.value = noise.normal(SLOW));
        Self { noise, drift }
    }

    /// Measures the next fix, which is one of [`RATE`] a second.
    pub fn measure(&mut self, world: &arcade::World, home: Home) -> Fix {
        self.drift.iter_mut().for_each(|drift| drift.step(&mut self.noise, 1.0 / f64::from(RATE)));
        let mut error = self.drift.each_ref().map(|drift| drift.value);
        error.iter_mut().for_each(|error| *error += self.noise.normal(WHITE));
        let speed_error = [self.noise.normal(SPEED_WHITE), self.noise.normal(SPEED_WHITE)];
        gps_fix(world, error, speed_error, home)
    }
}

/// The fix at the true position of `world` with errors east, north and up in metres, and of the speed in m/s.
pub fn gps_fix(world: &arcade::World, error: [f64; 3], speed_error: [f64; 2], home: Home) -> Fix {
    let position = world.position.unwrap_or_default();
    let velocity = world.velocity.unwrap_or_default();
    let (latitude, longitude) = geodesy::to_degrees(home, position.x + error[0], position.y + error[1]);
    Fix {
        time_us: world.time_us,
        quality: FixQuality::FixQuality3d.into(),
        latitude,
        longitude,
        altitude: home.altitude + position.z + HEIGHT_WORSE * error[2],
        east_speed: velocity.x + speed_error[0],
        north_speed: velocity.y + speed_error[1],
        satellites: SATELLITES,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::arcade::Vector;

    const HOME: Home = Home { latitude: 50.6866, longitude: 10.9190, altitude: 480.0 };

    fn world() -> arcade::World {
        let position = Some(Vector { x: 12.0, y: -7.0, z: 5.0 });
        let velocity = Some(Vector { x: 1.0, y: 2.0, z: 0.5 });
        arcade::World { time_us: 200_000, position, velocity, ..arcade::World::default() }
    }

    #[test]
    fn without_errors_a_fix_is_the_truth() {
        let fix = gps_fix(&world(), [0.0; 3], [0.0; 2], HOME);
        let (east, north) = geodesy::to_metres(HOME, fix.latitude, fix.longitude);
        assert!((east - 12.0).abs() < 1e-6 && (north + 7.0).abs() < 1e-6, "{east} {north}");
        assert_eq!((fix.time_us, fix.altitude, fix.east_speed, fix.north_speed), (200_000, 485.0, 1.0, 2.0));
    }

    #[test]
    fn the_receiver_is_wrong_by_some_decimetres() {
        let mut receiver = Receiver::new(1);
        let errors: Vec<f64> = (0..5000)
            .map(|_| {
                let fix = receiver.measure(&world(), HOME);
                geodesy::to_metres(HOME, fix.latitude, fix.longitude).0 - 12.0
            })
            .collect();
        let sigma = (errors.iter().map(|error| error * error).sum::<f64>() / 5000.0).sqrt();
        // Of 0.15 m white and 0.15 m slow.
        assert!((sigma - 0.212).abs() < 0.04, "{sigma}");
    }
}
