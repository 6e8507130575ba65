//! Estimation of position and velocity: complementary filters of acceleration, GPS and height sensors.
//!
//! Accelerations are integrated, which is exact for seconds; slow measurements correct what drifts (Higgins, A
//! Comparison of Complementary and Kalman Filtering, 1975). The vertical filter is of third order with equal poles, so
//! that it also learns the bias of the acceleration (ArduPilot's `AP_InertialNav`). A measurement is compared with the
//! estimate of the time at which it was taken, from a ring of past estimates (Larsen et al., Incorporation of Time
//! Delayed Measurements in a Discrete-time Kalman Filter, 1998).

use super::parameters::Parameters;
use super::quaternion::Quaternion;
use super::vector::{Vec3, limit};
use crate::arcade::height::Range;
use crate::arcade::{Fix, FixQuality, Height};
use crate::geodesy;

pub const GRAVITY: f64 = 9.81; // m/s^2

/// Number of past estimates that are kept: those of 0.85 s at 300 Hz.
const HISTORY: usize = 256;
/// Without a fix for this long, the position is no longer valid.
const FIX_TIMEOUT_US: u64 = 5_000_000;
/// The filters' longest step, s: after a gap one measurement must not count for many.
const LONGEST_STEP: f64 = 0.4;
/// No working accelerometer has a larger error, m/s^2.
const MAX_BIAS: f64 = 1.0;

/// The estimate of one beat.
#[derive(Clone, Copy, Debug, Default)]
struct Past {
    time_us: u64,
    position: Vec3,
    velocity: Vec3,
    /// The cosine of the angle between the body's z axis and the vertical.
    upright: f64,
}

/// What is known about position and velocity, in metres and m/s, x east, y north, z up from home.
#[derive(Clone, Debug)]
pub struct PositionEstimator {
    pub position: Vec3,
    pub velocity: Vec3,
    /// Bias of the acceleration in the world's axes, m/s^2.
    pub bias: Vec3,
    /// By how much the barometer reads too high, m.
    pub barometer_offset: f64,
    /// When the last fix was measured; 0 before the first.
    pub fix_us: u64,
    /// When the last height was measured; 0 before the first.
    pub height_us: u64,
    history: [Past; HISTORY],
    /// The index in `history` of the next estimate.
    next: usize,
}

impl Default for PositionEstimator {
    fn default() -> Self {
        Self {
            position: Vec3::ZERO,
            velocity: Vec3::ZERO,
            bias: Vec3::ZERO,
            barometer_offset: 0.0,
            fix_us: 0,
            height_us: 0,
            history: [Past::default(); HISTORY],
            next: 0,
        }
    }
}

impl PositionEstimator {
    /// Integrates the specific force in body axes over the `elapsed` seconds before `time_us`.
    pub fn predict(&mut self, time_us: u64, force: Vec3, attitude: Quaternion, elapsed: f64) {
        let gravity = Vec3::new(0.0, 0.0, GRAVITY);
        let acceleration = attitude.rotate(force) - gravity - self.bias;
        self.position += self.velocity * elapsed + acceleration * (0.5 * elapsed * elapsed);
        self.velocity += acceleration * elapsed;
        self.remember(time_us, attitude);
    }

    /// Carries on over a gap in the readings, at constant velocity.
    pub fn coast(&mut self, time_us: u64, attitude: Quaternion, elapsed: f64) {
        self.position += self.velocity * elapsed;
        self.remember(time_us, attitude);
    }

    fn remember(&mut self, time_us: u64, attitude: Quaternion) {
        let upright = attitude.up().z;
        self.history[self.next] = Past { time_us, position: self.position, velocity: self.velocity, upright };
        self.next = (self.next + 1) % HISTORY;
    }

    /// Returns the newest estimate that is not newer than `time_us`, or `None` if all are newer, for example because
    /// `time_us` is before a restart.
    fn past(&self, time_us: u64) -> Option<Past> {
        for age in 1..=HISTORY {
            let past = self.history[(self.next + HISTORY - age) % HISTORY];
            if past.time_us != 0 && past.time_us <= time_us {
                return Some(past);
            }
        }
        None
    }

    /// Corrects the estimate with a height. Above the ultrasonic sensor's range, this is the barometer's, less the
    /// offset that was learned within the range.
    pub fn correct_height(&mut self, height: &Height, parameters: &Parameters) {
        let Some(past) = self.past(height.time_us) else { return };
        let elapsed = step(self.height_us, height.time_us);
        self.height_us = height.time_us;
        let measured = match height.range {
            // The sensor measures along the body's z axis, so correct for the tilt.
            Some(Range::Ultrasonic(range)) if range.is_finite() => {
                let measured = range * past.upright;
                let change = height.barometer - measured - self.barometer_offset;
                self.barometer_offset += change * limit(parameters.barometer_correction * elapsed, 1.0);
                measured
            }
            _ => height.barometer - self.barometer_offset,
        };
        let error = measured - past.position.z;
        if !error.is_finite() {
            return;
        }
        let bandwidth = parameters.height_correction;
        self.position.z += error * (3.0 * bandwidth * elapsed);
        self.velocity.z += error * (3.0 * bandwidth * bandwidth * elapsed);
        let bias = self.bias.z - error * (bandwidth * bandwidth * bandwidth * elapsed);
        self.bias.z = limit(bias, MAX_BIAS);
    }

    /// Corrects the estimate with the horizontal position and velocity of a fix. Its height is not used, because the
    /// other sensors' are better.
    pub fn correct_fix(&mut self, fix: &Fix, parameters: &Parameters) {
        // Without home, it is no place that the vehicle knows.
        if fix.quality() == FixQuality::None || !parameters.limits.are_known() {
            return;
        }
        let (east, north) = geodesy::to_metres(parameters.limits.home(), fix.latitude, fix.longitude);
        let position = Vec3::new(east, north, 0.0);
        let velocity = Vec3::new(fix.east_speed, fix.north_speed, 0.0);
        if !position.is_finite() || !velocity.is_finite() {
            return;
        }
        if self.fix_us == 0 {
            self.position = Vec3::new(position.x, position.y, self.position.z);
            self.velocity = Vec3::new(velocity.x, velocity.y, self.velocity.z);
            self.fix_us = fix.time_us;
            return;
        }
        let Some(past) = self.past(fix.time_us) else { return };
        let elapsed = step(self.fix_us, fix.time_us);
        self.fix_us = fix.time_us;
        let mut position_error = position - past.position;
        let mut velocity_error = velocity - past.velocity;
        position_error.z = 0.0;
        velocity_error.z = 0.0;
        self.position += position_error * limit(parameters.position_correction * elapsed, 1.0);
        self.velocity += velocity_error * limit(parameters.velocity_correction * elapsed, 1.0);
        let bias = self.bias - velocity_error * (parameters.bias_correction * elapsed);
        self.bias = Vec3::new(limit(bias.x, MAX_BIAS), limit(bias.y, MAX_BIAS), bias.z);
    }

    /// Returns false before the first fix and long after the last one.
    pub fn is_valid(&self, time_us: u64) -> bool {
        self.fix_us != 0 && time_us <= self.fix_us + FIX_TIMEOUT_US
    }
}

/// Returns the seconds from the last measurement to this one, limited to `LONGEST_STEP`.
fn step(last_us: u64, time_us: u64) -> f64 {
    if last_us == 0 || time_us <= last_us {
        return 0.0;
    }
    let elapsed = (time_us - last_us) as f64 * 1e-6;
    if elapsed > LONGEST_STEP { LONGEST_STEP } else { elapsed }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAT_US: u64 = 3_333;
    const BEAT: f64 = 0.003_333;
    const AT_REST: Vec3 = Vec3::new(0.0, 0.0, GRAVITY);

    /// What the sensors of a vehicle that moves at a constant velocity measure of it, with delays as in the system.
    fn fly(velocity: Vec3, force: Vec3, seconds: f64) -> (PositionEstimator, Vec3) {
        let parameters = Parameters::defaults();
        let mut estimator = PositionEstimator::default();
        let truth = |beat: u64| velocity * (beat as f64 * BEAT) + Vec3::new(0.0, 0.0, 1.0);
        let beats = (seconds / BEAT) as u64;
        for beat in 1..=beats {
            estimator.predict(beat * BEAT_US, force, Quaternion::default(), BEAT);
            if beat % 15 == 6 {
                estimator.correct_height(&height_at(beat - 5, truth(beat - 5)), &parameters);
            }
            if beat % 60 == 18 {
                estimator.correct_fix(&fix_at(beat - 17, truth(beat - 17), velocity), &parameters);
            }
        }
        (estimator, truth(beats))
    }

    fn height_at(beat: u64, position: Vec3) -> Height {
        let range = (position.z < 6.0).then_some(Range::Ultrasonic(position.z));
        Height { time_us: beat * BEAT_US, range, barometer: position.z + 0.7 }
    }

    fn fix_at(beat: u64, position: Vec3, velocity: Vec3) -> Fix {
        let (latitude, longitude) = geodesy::to_degrees(Parameters::defaults().limits.home(), position.x, position.y);
        let (east_speed, north_speed) = (velocity.x, velocity.y);
        Fix { time_us: beat * BEAT_US, quality: 2, latitude, longitude, east_speed, north_speed, ..Fix::default() }
    }

    #[test]
    fn delayed_measurements_do_not_make_the_estimate_late() {
        let velocity = Vec3::new(3.0, -2.0, 0.0);
        let (estimator, truth) = fly(velocity, AT_REST, 30.0);
        // Fixes that were taken as present would put it 60 ms behind, 0.2 m.
        assert!((estimator.position - truth).length() < 0.02, "{:?} {truth:?}", estimator.position);
        assert!((estimator.velocity - velocity).length() < 0.01, "{:?}", estimator.velocity);
    }

    #[test]
    fn the_bias_of_the_accelerometer_is_learned() {
        let bias = Vec3::new(0.1, -0.2, 0.15);
        let (estimator, truth) = fly(Vec3::ZERO, AT_REST + bias, 120.0);
        assert!((estimator.bias - bias).length() < 0.01, "{:?}", estimator.bias);
        assert!((estimator.position - truth).length() < 0.05, "{:?}", estimator.position);
    }

    #[test]
    fn above_the_ultrasonic_range_the_barometer_is_corrected_by_its_offset() {
        let (estimator, truth) = fly(Vec3::new(0.0, 0.0, 0.3), AT_REST, 30.0);
        assert!((estimator.barometer_offset - 0.7).abs() < 0.01, "{}", estimator.barometer_offset);
        assert!(truth.z > 9.0 && (estimator.position.z - truth.z).abs() < 0.05, "{:?}", estimator.position);
    }

    #[test]
    fn the_range_of_a_tilted_vehicle_is_not_its_height() {
        let mut estimator = PositionEstimator { position: Vec3::new(0.0, 0.0, 5.0), ..PositionEstimator::default() };
        let attitude = Quaternion::from_angles(Vec3::new(0.3, 0.2, 0.0));
        let range = 5.0 / (0.3_f64.cos() * 0.2_f64.cos());
        for beat in 1..=300 {
            estimator.coast(beat * BEAT_US, attitude, BEAT);
            let range = Some(Range::Ultrasonic(range));
            let height = Height { time_us: beat * BEAT_US, range, barometer: 5.0 };
            estimator.correct_height(&height, &Parameters::defaults());
        }
        assert!((estimator.position.z - 5.0).abs() < 1e-9, "{:?}", estimator.position);
    }

    #[test]
    fn the_first_fix_sets_the_position_and_old_fixes_invalidate_it() {
        let mut estimator = PositionEstimator::default();
        assert!(!estimator.is_valid(1_000_000));
        estimator.correct_fix(&fix_at(300, Vec3::new(7.0, -4.0, 0.0), Vec3::ZERO), &Parameters::defaults());
        assert!((estimator.position - Vec3::new(7.0, -4.0, 0.0)).length() < 1e-6);
        assert!(estimator.is_valid(300 * BEAT_US + 5_000_000));
        assert!(!estimator.is_valid(300 * BEAT_US + 5_000_001));
    }

    #[test]
    fn measurements_that_are_useless_are_ignored() {
        let (mut estimator, _) = fly(Vec3::ZERO, AT_REST, 2.0);
        let before = (estimator.position, estimator.velocity);
        let now = 2_000_000 / BEAT_US;
        let parameters = Parameters::defaults();
        estimator.correct_fix(&Fix { quality: 0, ..fix_at(now, Vec3::new(9.0, 0.0, 0.0), Vec3::ZERO) }, &parameters);
        estimator.correct_fix(&Fix { latitude: f64::NAN, ..fix_at(now, Vec3::ZERO, Vec3::ZERO) }, &parameters);
        // Older than any estimate.
        estimator.correct_fix(&fix_at(10, Vec3::new(9.0, 0.0, 0.0), Vec3::ZERO), &parameters);
        estimator.correct_height(&height_at(10, Vec3::new(0.0, 0.0, 5.0)), &parameters);
        estimator.correct_height(&Height { range: None, barometer: f64::NAN, time_us: now * BEAT_US }, &parameters);
        assert_eq!((estimator.position, estimator.velocity), before);
    }
}
