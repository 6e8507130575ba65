//! The moving set-point on the way to a target, with limited speed and acceleration.
//!
//! The vehicle follows a point that starts, cruises and brakes as the vehicle itself can, so the controllers stay in
//! their linear range. Braking follows the square-root law of ArduPilot's position controller, with a linear part near
//! the target.

use super::parameters::Parameters;
use super::vector::{Vec3, angle_between, limit};

/// Braking uses this share of the acceleration, because the acceleration itself takes time to build up.
const BRAKING: f64 = 0.5;
/// Near the target, speed is proportional to the distance, 1/s.
const APPROACH: f64 = 0.9;
/// How fast the velocity follows, 1/s, and the time in which the acceleration builds up, s: without steps in the
/// acceleration, the vehicle tilts smoothly.
const RESPONSE: f64 = 2.5;
const BUILD_UP: f64 = 0.2;

/// Where the vehicle is to be now.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SetPoint {
    pub position: Vec3,
    pub velocity: Vec3,
    pub acceleration: Vec3,
    /// Radians.
    pub yaw: f64,
}

/// Where the set-point moves, and how fast.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    pub target: Vec3,
    pub yaw: f64,
    /// Maximum horizontal speed, m/s.
    pub speed: f64,
    /// Maximum vertical speed, m/s, up and down.
    pub climb: f64,
}

impl SetPoint {
    /// Creates a set-point at rest.
    pub fn at(position: Vec3, yaw: f64) -> Self {
        Self { position, yaw, ..Self::default() }
    }

    /// Advances by `elapsed` seconds. Horizontal and vertical movement are independent.
    pub fn advance(&mut self, leg: &Leg, parameters: &Parameters, elapsed: f64) {
        let limit_acceleration = parameters.limit_acceleration;
        let way = leg.target - self.position;
        let distance = way.horizontal();
        let speed = speed_at(distance, leg.speed, limit_acceleration);
        let share = if distance > 1e-6 { speed / distance } else { 0.0 };
        let climb = speed_at(way.z.abs(), leg.climb, limit_acceleration);
        let velocity = Vec3::new(way.x * share, way.y * share, if way.z < 0.0 { -climb } else { climb });

        let mut wanted = (velocity - self.velocity) * RESPONSE;
        let horizontal = wanted.horizontal();
        if horizontal > limit_acceleration {
            wanted.x *= limit_acceleration / horizontal;
            wanted.y *= limit_acceleration / horizontal;
        }
        wanted.z = limit(wanted.z, limit_acceleration);
        self.acceleration += (wanted - self.acceleration) * (elapsed / BUILD_UP);
        self.velocity += self.acceleration * elapsed;
        self.position += self.velocity * elapsed;

        let turn = angle_between(self.yaw, leg.yaw);
        self.yaw += limit(turn, parameters.limit_yaw_rate.to_radians() * elapsed);
    }
}

/// Returns the speed, at most `cruise`, from which the vehicle can still stop at a target at this distance.
fn speed_at(distance: f64, cruise: f64, acceleration: f64) -> f64 {
    let braking = (2.0 * BRAKING * acceleration * distance).sqrt();
    let near = APPROACH * distance;
    let slower = if braking < near { braking } else { near };
    if slower < cruise { slower } else { cruise }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BEAT: f64 = 1.0 / 300.0;

    fn leg(target: Vec3) -> Leg {
        Leg { target, yaw: 1.0, speed: 3.0, climb: 1.0 }
    }

    #[test]
    fn the_target_is_reached_without_overshoot_and_within_limits() {
        let target = Vec3::new(15.0, 0.0, 5.0);
        let mut point = SetPoint::default();
        let (mut fastest, mut farthest): (f64, f64) = (0.0, 0.0);
        for _ in 0..300 * 15 {
            let before = point.velocity;
            point.advance(&leg(target), &Parameters::defaults(), BEAT);
            fastest = fastest.max(point.velocity.horizontal());
            farthest = farthest.max(point.position.x);
            assert!((point.velocity - before).horizontal() <= 1.5 * BEAT + 1e-9);
            assert!(point.velocity.z <= 1.1);
        }
        assert!((point.position - target).length() < 0.02, "{point:?}");
        assert!((2.9..3.1).contains(&fastest), "{fastest}");
        assert!(farthest < 15.05, "{farthest}");
        assert!((point.yaw - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_turn_takes_the_shorter_way() {
        let mut point = SetPoint::at(Vec3::ZERO, 3.0);
        let leg = Leg { yaw: -3.0, ..leg(Vec3::ZERO) };
        point.advance(&leg, &Parameters::defaults(), BEAT);
        assert!(point.yaw > 3.0);
    }
}
