//! Contact with flat ground: four feet with springs, dampers and friction.

use super::body::{Body, Load};
use glam::DVec3;

/// Distance of a foot from the body's x and y axes, m.
const REACH: f64 = 0.12;
const STIFFNESS: f64 = 2500.0; // N/m
const DAMPING: f64 = 60.0; // N s/m
const FRICTION: f64 = 0.6;
/// Below this speed, friction decreases with speed, m/s; otherwise it would alternate between two directions.
const CREEP: f64 = 0.01;
/// Height of the centre of mass above the feet, m.
const LEG: f64 = 0.1;

/// Returns the load of the feet that touch the ground, or `None` in the air.
pub fn load(body: &Body) -> Option<Load> {
    let corners = [(REACH, REACH), (REACH, -REACH), (-REACH, REACH), (-REACH, -REACH)];
    corners.into_iter().filter_map(|(x, y)| foot(body, x, y)).reduce(|sum, foot| sum + foot)
}

fn foot(body: &Body, x: f64, y: f64) -> Option<Load> {
    let at_rest = DVec3::new(x, y, 0.0);
    let position = body.position + body.attitude * at_rest;
    if position.z > 0.0 {
        return None;
    }
    let velocity = body.velocity + body.attitude * body.rates.cross(at_rest);
    let normal = (-position.z * STIFFNESS - velocity.z * DAMPING).max(0.0);
    let sliding = DVec3::new(velocity.x, velocity.y, 0.0);
    let force = DVec3::Z * normal - sliding * (FRICTION * normal / sliding.length().max(CREEP));
    let lever = at_rest - DVec3::Z * LEG;
    Some(Load { force, torque: lever.cross(body.attitude.inverse() * force) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_touches_the_ground_in_the_air() {
        assert!(load(&Body { position: DVec3::Z * 0.01, ..Body::default() }).is_none());
    }

    #[test]
    fn the_feet_push_back_and_slow_down() {
        let position = DVec3::Z * -0.002;
        let pushed = load(&Body { position, velocity: DVec3::X, ..Body::default() }).expect("contact");
        assert!((pushed.force.z - 4.0 * 5.0).abs() < 1e-9, "{pushed:?}");
        assert!((pushed.force.x + FRICTION * pushed.force.z).abs() < 1e-9, "{pushed:?}");
    }

    #[test]
    fn a_tilted_body_is_turned_upright() {
        let tilted = glam::DQuat::from_rotation_x(0.1);
        let pushed = load(&Body { attitude: tilted, ..Body::default() }).expect("contact");
        assert!(pushed.torque.x < 0.0, "{pushed:?}");
    }
}
