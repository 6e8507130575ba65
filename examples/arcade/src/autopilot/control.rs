//! Control: a cascade from position to velocity, attitude and angular rates.
//!
//! Position P, velocity PI with feed-forward, attitude P on quaternions, rates PID, as in PX4's multicopter
//! controllers; the attitude law is that of Brescianini, Hehn and D'Andrea, Nonlinear Quadrocopter Attitude Control,
//! 2013. Integrators stop when an actuator has reached its limit (Astrom and Hagglund, PID Controllers, 1995, section
//! 3.5).

use super::mixer::Demand;
use super::parameters::Parameters;
use super::position::GRAVITY;
use super::quaternion::Quaternion;
use super::trajectory::SetPoint;
use super::vector::{Vec3, clamp, limit};

/// Limit of the rates set by the attitude controller, rad/s.
const MAX_RATE: f64 = 3.5;
/// Limit of the integral of angular rates, as a difference of motor set-points.
const MAX_TORQUE_INTEGRAL: f64 = 0.1;
/// Limit of the integral of velocity, m/s^2.
const MAX_ACCELERATION_INTEGRAL: f64 = 4.0;
/// The differentiated rates pass a low-pass filter with this time constant, s.
const DERIVATIVE_TIME: f64 = 0.008;

/// The thrust that the position controller asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrust {
    /// The thrust as specific force, m/s^2, in the world's axes.
    pub force: Vec3,
    /// The attitude with the body's z axis along the force.
    pub attitude: Quaternion,
}

/// The controller from position to specific force.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct VelocityController {
    /// m/s^2.
    pub integral: Vec3,
}

impl VelocityController {
    /// Returns the thrust towards the set-point. With `level`, the horizontal position is unknown, so only what the
    /// integral has learned about the wind acts against it.
    pub fn update(
        &mut self,
        set_point: &SetPoint,
        position: Vec3,
        velocity: Vec3,
        level: bool,
        parameters: &Parameters,
        elapsed: f64,
    ) -> Thrust {
        let wanted = wanted_velocity(set_point, position, parameters);
        let mut error = wanted - velocity;
        let mut force = set_point.acceleration + self.integral;
        force.z += parameters.climb_p * error.z + GRAVITY;
        if level {
            error = Vec3::new(0.0, 0.0, error.z);
            force.x = self.integral.x;
            force.y = self.integral.y;
        }
        force.x += parameters.velocity_p * error.x;
        force.y += parameters.velocity_p * error.y;

        let limited = limit_force(force, parameters);
        self.integrate(error, limited - force, parameters, elapsed);
        Thrust { force: limited, attitude: attitude_along(limited, set_point.yaw) }
    }

    /// Grows the integral unless that would push further beyond a limit that was reached.
    fn integrate(&mut self, error: Vec3, cut: Vec3, parameters: &Parameters, elapsed: f64) {
        let horizontal = parameters.velocity_i * elapsed;
        self.integral.x += if cut.x * error.x < 0.0 { 0.0 } else { error.x * horizontal };
        self.integral.y += if cut.y * error.y < 0.0 { 0.0 } else { error.y * horizontal };
        self.integral.z += if cut.z * error.z < 0.0 { 0.0 } else { error.z * (parameters.climb_i * elapsed) };
        self.integral.x = limit(self.integral.x, MAX_ACCELERATION_INTEGRAL);
        self.integral.y = limit(self.integral.y, MAX_ACCELERATION_INTEGRAL);
        self.integral.z = limit(self.integral.z, MAX_ACCELERATION_INTEGRAL);
    }
}

/// The velocity that leads back to the set-point while it moves.
fn wanted_velocity(set_point: &SetPoint, position: Vec3, parameters: &Parameters) -> Vec3 {
    let error = set_point.position - position;
    let mut wanted = Vec3::new(
        set_point.velocity.x + parameters.position_p * error.x,
        set_point.velocity.y + parameters.position_p * error.y,
        set_point.velocity.z + parameters.height_p * error.z,
    );
    let speed = wanted.horizontal();
    if speed > parameters.limits.speed {
        wanted.x *= parameters.limits.speed / speed;
        wanted.y *= parameters.limits.speed / speed;
    }
    wanted.z = limit(wanted.z, parameters.limits.climb);
    wanted
}

/// Limits the vertical force by the motors' thrust, and then the horizontal force by the tilt.
fn limit_force(force: Vec3, parameters: &Parameters) -> Vec3 {
    let per_thrust = GRAVITY / parameters.thrust_hover;
    let z = clamp(force.z, parameters.thrust_minimum * per_thrust, parameters.thrust_maximum * per_thrust);
    let most = z * parameters.limit_tilt.to_radians().tan();
    let horizontal = force.horizontal();
    let kept = if horizontal > most { most / horizontal } else { 1.0 };
    Vec3::new(force.x * kept, force.y * kept, z)
}

/// The attitude with the body's z axis along `force`, turned to `yaw`.
fn attitude_along(force: Vec3, yaw: f64) -> Quaternion {
    let up = force * (1.0 / force.length());
    let tilt = Quaternion { w: 1.0 + up.z, x: -up.y, y: up.x, z: 0.0 }.normalized();
    tilt.multiply(Quaternion::from_angles(Vec3::new(0.0, 0.0, yaw)))
}

/// The controller from attitude to torques.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RateController {
    /// Differences of motor set-points.
    pub integral: Vec3,
    /// Angular rates at the last beat, rad/s.
    pub rates: Vec3,
    /// Filtered derivative of the rates, rad/s^2.
    pub derivative: Vec3,
}

impl RateController {
    /// Returns the demand on the motors. `cut` is by how much they missed roll, pitch and yaw at the last beat, see
    /// [`Mixed`](super::mixer::Mixed).
    pub fn update(
        &mut self,
        thrust: &Thrust,
        attitude: Quaternion,
        rates: Vec3,
        cut: Vec3,
        parameters: &Parameters,
        elapsed: f64,
    ) -> Demand {
        let error = wanted_rates(thrust.attitude, attitude, parameters) - rates;
        self.integral = Vec3::new(
            integrate_rate(self.integral.x, error.x, cut.x, parameters.rate_i * elapsed),
            integrate_rate(self.integral.y, error.y, cut.y, parameters.rate_i * elapsed),
            integrate_rate(self.integral.z, error.z, cut.z, parameters.yaw_rate_i * elapsed),
        );
        let slope = (rates - self.rates) * (1.0 / elapsed);
        self.derivative += (slope - self.derivative) * (elapsed / (DERIVATIVE_TIME + elapsed));
        self.rates = rates;
        // The component of the force along the current thrust axis: the body may still be turning towards the force.
        let along = thrust.force.dot(attitude.up()) * (parameters.thrust_hover / GRAVITY);
        Demand {
            thrust: clamp(along, parameters.thrust_minimum, parameters.thrust_maximum),
            roll: parameters.rate_p * error.x + self.integral.x - parameters.rate_d * self.derivative.x,
            pitch: parameters.rate_p * error.y + self.integral.y - parameters.rate_d * self.derivative.y,
            yaw: parameters.yaw_rate_p * error.z + self.integral.z,
        }
    }
}

/// Grows the integral of an axis unless that would push further in the direction in which the motors could not follow.
fn integrate_rate(integral: f64, error: f64, cut: f64, gain: f64) -> f64 {
    let grown = if cut * error < 0.0 { integral } else { integral + error * gain };
    limit(grown, MAX_TORQUE_INTEGRAL)
}

/// Rates that turn the body to the wanted attitude, in body axes.
fn wanted_rates(wanted: Quaternion, attitude: Quaternion, parameters: &Parameters) -> Vec3 {
    let error = attitude.conjugate().multiply(wanted).rotation_vector();
    Vec3::new(
        limit(parameters.attitude_p * error.x, MAX_RATE),
        limit(parameters.attitude_p * error.y, MAX_RATE),
        limit(parameters.yaw_p * error.z, parameters.limit_yaw_rate.to_radians()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAT: f64 = 1.0 / 300.0;

    fn thrust(controller: &mut VelocityController, set_point: &SetPoint, velocity: Vec3) -> Thrust {
        controller.update(set_point, Vec3::ZERO, velocity, false, &Parameters::defaults(), BEAT)
    }

    #[test]
    fn at_the_set_point_thrust_is_weight() {
        let thrust = thrust(&mut VelocityController::default(), &SetPoint::default(), Vec3::ZERO);
        assert!((thrust.force - Vec3::new(0.0, 0.0, GRAVITY)).length() < 1e-12);
        let demand = RateController::default().update(
            &thrust,
            Quaternion::default(),
            Vec3::ZERO,
            Vec3::ZERO,
            &Parameters::defaults(),
            BEAT,
        );
        assert!((demand.thrust - 0.45).abs() < 1e-12 && demand.roll == 0.0 && demand.pitch == 0.0, "{demand:?}");
    }

    #[test]
    fn to_fly_east_it_lowers_the_nose_and_to_fly_north_it_rolls_left() {
        let east = SetPoint::at(Vec3::new(2.0, 0.0, 0.0), 0.0);
        let angles = thrust(&mut VelocityController::default(), &east, Vec3::ZERO).attitude.angles();
        assert!(angles.y > 0.1 && angles.x.abs() < 1e-9, "{angles:?}");
        let north = SetPoint::at(Vec3::new(0.0, 2.0, 0.0), 0.0);
        let angles = thrust(&mut VelocityController::default(), &north, Vec3::ZERO).attitude.angles();
        assert!(angles.x < -0.1 && angles.y.abs() < 1e-9, "{angles:?}");
    }

    #[test]
    fn the_tilt_is_limited_and_the_integral_does_not_wind_up() {
        let far = SetPoint::at(Vec3::new(50.0, 0.0, 0.0), 0.0);
        let mut controller = VelocityController::default();
        for _ in 0..3000 {
            let up = thrust(&mut controller, &far, Vec3::new(-20.0, 0.0, 0.0)).attitude.up();
            assert!(up.z.acos() <= 25.0_f64.to_radians() + 1e-9);
        }
        assert_eq!(controller.integral.x, 0.0);
    }

    #[test]
    fn thrust_is_limited_and_the_integral_does_not_wind_up() {
        let high = SetPoint::at(Vec3::new(0.0, 0.0, 50.0), 0.0);
        let mut controller = VelocityController::default();
        let most = (0..3000).map(|_| thrust(&mut controller, &high, Vec3::new(0.0, 0.0, -9.0)).force.z).last();
        assert_eq!(most, Some(GRAVITY / 0.45 * 0.9));
        assert_eq!(controller.integral.z, 0.0);
    }

    #[test]
    fn parameters_that_contradict_each_other_do_not_end_the_program() {
        let parameters = Parameters { thrust_minimum: 0.9, thrust_maximum: 0.1, ..Parameters::defaults() };
        let force = Vec3::new(0.0, 0.0, GRAVITY);
        assert!(limit_force(force, &parameters).is_finite());
    }

    #[test]
    fn a_steady_wind_is_learned_by_the_integral() {
        let mut controller = VelocityController::default();
        let mut velocity = 0.0;
        for _ in 0..6000 {
            let force = thrust(&mut controller, &SetPoint::default(), Vec3::new(velocity, 0.0, 0.0)).force.x;
            velocity += (force + 0.75) * BEAT;
        }
        assert!(velocity.abs() < 0.01 && (controller.integral.x + 0.75).abs() < 0.02, "{velocity} {controller:?}");
    }

    #[test]
    fn torques_act_against_errors_of_attitude_and_rates() {
        let level = thrust(&mut VelocityController::default(), &SetPoint::default(), Vec3::ZERO);
        let tilted = Quaternion::from_angles(Vec3::new(0.2, -0.2, 0.2));
        let parameters = Parameters::defaults();
        let demand = RateController::default().update(&level, tilted, Vec3::ZERO, Vec3::ZERO, &parameters, BEAT);
        assert!(demand.roll < 0.0 && demand.pitch > 0.0 && demand.yaw < 0.0, "{demand:?}");
        let rates = Vec3::new(1.0, 1.0, 1.0);
        let mut controller = RateController { rates, ..RateController::default() };
        let demand = controller.update(&level, Quaternion::default(), rates, Vec3::ZERO, &parameters, BEAT);
        assert!(demand.roll < 0.0 && demand.pitch < 0.0 && demand.yaw < 0.0, "{demand:?}");
    }

    #[test]
    fn an_axis_at_its_limit_keeps_its_integral_and_no_others() {
        let level = thrust(&mut VelocityController::default(), &SetPoint::default(), Vec3::ZERO);
        let turned = Quaternion::from_angles(Vec3::new(0.2, 0.0, 0.2));
        let integral = |cut| {
            let mut controller = RateController::default();
            controller.update(&level, turned, Vec3::ZERO, cut, &Parameters::defaults(), BEAT);
            controller.integral
        };
        let missed_yaw = integral(Vec3::new(0.0, 0.0, 0.1));
        assert!(missed_yaw.x < 0.0 && missed_yaw.z == 0.0, "{missed_yaw:?}");
        // It is only kept from growing in the direction in which the motors could not follow.
        assert!(integral(Vec3::new(0.0, 0.0, -0.1)).z < 0.0);
    }
}
