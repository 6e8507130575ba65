//! Motors with propellers, and the controllers that drive them.

use super::body::Load;
use glam::{DQuat, DVec3};

pub const MAX_THRUST: f64 = 6.5; // N for each motor
const TIME_CONSTANT: f64 = 0.03; // s
/// Torque of a propeller's drag on the airframe, N m for each N of thrust.
const YAW_TORQUE: f64 = 0.016;
/// Distance of a motor from the body's x and y axes: an arm of 0.225 m at 45 degrees.
const ARM: f64 = 0.225 * std::f64::consts::FRAC_1_SQRT_2; // m
/// Power is proportional to thrust to the power of 1.5 (momentum theory of the ideal rotor), W for 1 N.
const POWER: f64 = 6.6;
/// Power of the electronics, W.
const IDLE_POWER: f64 = 5.0;

/// Positions in the order of the message: front left, front right, rear left, rear right.
const POSITIONS: [DVec3; 4] =
    [DVec3::new(ARM, ARM, 0.0), DVec3::new(ARM, -ARM, 0.0), DVec3::new(-ARM, ARM, 0.0), DVec3::new(-ARM, -ARM, 0.0)];
/// Front left and rear right turn clockwise and push the airframe counter-clockwise.
const TURNS: [f64; 4] = [1.0, -1.0, -1.0, 1.0];

/// The state of the four propellers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motors {
    /// N.
    pub thrust: [f64; 4],
}

impl Motors {
    /// Thrust follows the set-points, which are limited to 0 to 1.
    pub fn step(&mut self, set_points: [f64; 4], elapsed: f64) {
        for (thrust, set_point) in self.thrust.iter_mut().zip(set_points) {
            // A set-point that is not a number stops the motor.
            let wanted = if set_point.is_nan() { 0.0 } else { set_point.clamp(0.0, 1.0) * MAX_THRUST };
            *thrust += (wanted - *thrust) * (elapsed / TIME_CONSTANT);
        }
    }

    /// Force and torque on the airframe.
    pub fn load(&self, attitude: DQuat) -> Load {
        let total: f64 = self.thrust.iter().sum();
        let mut torque = DVec3::ZERO;
        for motor in 0..4 {
            torque += POSITIONS[motor].cross(DVec3::Z * self.thrust[motor]);
            torque.z += TURNS[motor] * YAW_TORQUE * self.thrust[motor];
        }
        Load { force: attitude * (DVec3::Z * total), torque }
    }

    /// Power that motors and electronics draw, W.
    pub fn power(&self) -> f64 {
        IDLE_POWER + POWER * self.thrust.iter().map(|thrust| thrust * thrust.sqrt()).sum::<f64>()
    }
}

/// The motors' controllers: they hold the last set-point for a while, then stop the motors.
#[derive(Clone, Copy, Debug, Default)]
pub struct MotorControllers {
    set_points: [f64; 4],
    received_us: u64,
}

/// How long a set-point is held.
pub const HOLD_US: u64 = 500_000;

impl MotorControllers {
    pub fn receive(&mut self, set_points: [f64; 4], now_us: u64) {
        *self = Self { set_points, received_us: now_us };
    }

    pub fn set_points(&self, now_us: u64) -> [f64; 4] {
        if self.silence_us(now_us) <= HOLD_US { self.set_points } else { [0.0; 4] }
    }

    /// Microseconds since the last set-point.
    pub fn silence_us(&self, now_us: u64) -> u64 {
        now_us - self.received_us
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(thrust: [f64; 4]) -> Load {
        Motors { thrust }.load(DQuat::IDENTITY)
    }

    #[test]
    fn thrust_follows_with_the_time_constant() {
        let mut motors = Motors::default();
        (0..30).for_each(|_| motors.step([1.0; 4], 0.001));
        assert!((motors.thrust[0] / MAX_THRUST - 0.632).abs() < 0.01, "{motors:?}");
    }

    #[test]
    fn set_points_out_of_range_are_limited() {
        let mut motors = Motors::default();
        (0..1000).for_each(|_| motors.step([7.0, -1.0, f64::NAN, 1.0], 0.001));
        assert!((motors.thrust[0] - MAX_THRUST).abs() < 1e-9 && motors.thrust[1] == 0.0 && motors.thrust[2] == 0.0);
    }

    #[test]
    fn each_pair_of_motors_turns_its_own_axis() {
        assert!(load([2.0, 1.0, 2.0, 1.0]).torque.x > 0.3, "left motors roll to the right");
        assert!(load([1.0, 1.0, 2.0, 2.0]).torque.y > 0.3, "rear motors lower the nose");
        assert!(load([2.0, 1.0, 1.0, 2.0]).torque.z > 0.03);
        assert!(load([2.0; 4]).torque.length() < 1e-12);
    }

    #[test]
    fn hovering_takes_about_140_watts() {
        let power = Motors { thrust: [2.943; 4] }.power();
        assert!((130.0..150.0).contains(&power), "{power}");
    }

    #[test]
    fn a_silent_autopilot_stops_the_motors_after_half_a_second() {
        let mut controllers = MotorControllers::default();
        controllers.receive([0.5; 4], 1_000_000);
        assert_eq!(controllers.set_points(1_500_000), [0.5; 4]);
        assert_eq!(controllers.set_points(1_500_001), [0.0; 4]);
    }
}
