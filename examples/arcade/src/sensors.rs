//! The sensors on board: what they report of the world, with their errors.

pub mod gps;
pub mod height;
pub mod inertial;
pub mod power;

use crate::arcade;
use crate::world::World;
use glam::DVec3;

/// The true state of the world as a message.
pub fn truth(time_us: u64, world: &World) -> arcade::World {
    arcade::World {
        time_us,
        position: Some(vector(world.body.position)),
        velocity: Some(vector(world.body.velocity)),
        attitude: Some(vector(world.body.angles())),
        wind: Some(vector(world.wind.at_height(world.body.position.z))),
        on_ground: world.on_ground,
        charge_left: world.battery.charge_left(),
    }
}

fn vector(vector: DVec3) -> arcade::Vector {
    arcade::Vector { x: vector.x, y: vector.y, z: vector.z }
}
