//! The airframe as a rigid body (Beard and McLain, Small Unmanned Aircraft, 2012, chapter 3).

use glam::{DQuat, DVec3, EulerRot};
use std::ops::Add;

pub const MASS: f64 = 1.2; // kg
/// Moments of inertia about the body's axes, kg m^2.
pub const INERTIA: DVec3 = DVec3::new(0.012, 0.012, 0.022);

/// Position and motion. `position` is the point between the feet.
#[derive(Clone, Copy, Debug, Default)]
pub struct Body {
    pub position: DVec3,
    pub velocity: DVec3,
    /// Rotation from body axes to the world's.
    pub attitude: DQuat,
    /// Angular rates in body axes, rad/s.
    pub rates: DVec3,
}

/// What acts on the body: a force in the world's axes, N, and a torque in body axes, N m.
#[derive(Clone, Copy, Debug, Default)]
pub struct Load {
    pub force: DVec3,
    pub torque: DVec3,
}

impl Add for Load {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self { force: self.force + other.force, torque: self.torque + other.torque }
    }
}

impl Body {
    /// Semi-implicit Euler integration: velocities first, which keeps oscillations of the ground contact from growing.
    pub fn step(&mut self, load: Load, elapsed: f64) {
        self.velocity += load.force / MASS * elapsed;
        self.position += self.velocity * elapsed;
        let gyroscopic = self.rates.cross(INERTIA * self.rates);
        self.rates += (load.torque - gyroscopic) / INERTIA * elapsed;
        self.attitude = (self.attitude * DQuat::from_scaled_axis(self.rates * elapsed)).normalize();
    }

    /// Roll, pitch and yaw, rad.
    pub fn angles(&self) -> DVec3 {
        let (yaw, pitch, roll) = self.attitude.to_euler(EulerRot::ZYX);
        DVec3::new(roll, pitch, yaw)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_torque_turns_and_a_force_moves() {
        let mut body = Body::default();
        let load = Load { force: DVec3::new(1.2, 0.0, 0.0), torque: DVec3::new(0.0, 0.0, 0.022) };
        (0..1500).for_each(|_| body.step(load, 1.0 / 1500.0));
        assert!((body.velocity.x - 1.0).abs() < 1e-9 && (body.position.x - 0.5).abs() < 1e-3, "{body:?}");
        assert!((body.rates.z - 1.0).abs() < 1e-9 && (body.angles().z - 0.5).abs() < 1e-3, "{body:?}");
    }

    #[test]
    fn a_free_body_keeps_its_angular_momentum() {
        let mut body = Body { rates: DVec3::new(2.0, 0.1, 3.0), ..Body::default() };
        let momentum = |body: &Body| body.attitude * (INERTIA * body.rates);
        let before = momentum(&body);
        (0..1500).for_each(|_| body.step(Load::default(), 1.0 / 1500.0));
        assert!((momentum(&body) - before).length() < 0.002 * before.length(), "{}", momentum(&body));
    }
}
