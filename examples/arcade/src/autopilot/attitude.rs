//! Attitude estimation: a complementary filter of angular rates and angles.
//!
//! The passive filter on unit quaternions of Mahony, Hamel and Pflimlin, Nonlinear Complementary Filters on the Special
//! Orthogonal Group, 2008, section IV-C. Rates are exact for a short time but drift; the unit's own angles do not drift
//! but are noisy.

use super::parameters::Parameters;
use super::quaternion::Quaternion;
use super::vector::{Vec3, limit};

/// No working gyroscope has a larger bias, rad/s.
const MAX_BIAS: f64 = 0.1;

/// What is known about the attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct AttitudeEstimator {
    pub attitude: Quaternion,
    /// Bias of the gyroscopes, rad/s.
    pub bias: Vec3,
    /// Angular rates without the bias, in body axes, rad/s.
    pub rates: Vec3,
}

impl AttitudeEstimator {
    /// Sets the attitude from a reading, at the start and after a gap in the readings.
    pub fn reset(&mut self, rates: Vec3, angles: Vec3) {
        self.rates = rates - self.bias;
        self.attitude = Quaternion::from_angles(angles);
    }

    /// Updates the estimate with the next reading, `elapsed` seconds after the last.
    pub fn update(&mut self, rates: Vec3, angles: Vec3, elapsed: f64, parameters: &Parameters) {
        self.rates = rates - self.bias;
        let predicted = self.attitude.multiply(Quaternion::from_rotation_vector(self.rates * elapsed));
        let error = predicted.conjugate().multiply(Quaternion::from_angles(angles)).rotation_vector();
        let correction = error * (parameters.attitude_correction * elapsed);
        self.attitude = predicted.multiply(Quaternion::from_rotation_vector(correction)).normalized();
        let bias = self.bias - error * (parameters.gyro_bias_correction * elapsed);
        self.bias = Vec3::new(limit(bias.x, MAX_BIAS), limit(bias.y, MAX_BIAS), limit(bias.z, MAX_BIAS));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAT: f64 = 1.0 / 300.0;

    #[test]
    fn a_constant_bias_is_learned() {
        let mut estimator = AttitudeEstimator::default();
        let bias = Vec3::new(0.02, -0.01, 0.03);
        for _ in 0..300 * 60 {
            estimator.update(bias, Vec3::ZERO, BEAT, &Parameters::defaults());
        }
        assert!((estimator.bias - bias).length() < 1e-4, "{:?}", estimator.bias);
        assert!(estimator.attitude.angles().length() < 1e-3);
    }

    #[test]
    fn rates_are_integrated_without_delay() {
        let mut estimator = AttitudeEstimator::default();
        for beat in 1..=300 {
            let angle = f64::from(beat) * BEAT;
            estimator.update(Vec3::new(1.0, 0.0, 0.0), Vec3::new(angle, 0.0, 0.0), BEAT, &Parameters::defaults());
        }
        assert!((estimator.attitude.angles() - Vec3::new(1.0, 0.0, 0.0)).length() < 1e-9);
    }

    #[test]
    fn noise_of_the_angles_is_suppressed() {
        let mut estimator = AttitudeEstimator::default();
        let mut worst: f64 = 0.0;
        for beat in 0..3000 {
            let noise = if beat % 2 == 0 { 0.05 } else { -0.05 };
            estimator.update(Vec3::ZERO, Vec3::new(noise, noise, 0.0), BEAT, &Parameters::defaults());
            worst = worst.max(estimator.attitude.angles().length());
        }
        assert!(worst < 0.05 / 30.0, "{worst}");
    }
}
