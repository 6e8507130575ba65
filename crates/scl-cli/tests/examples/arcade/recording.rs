//! A recorded flight: what is true of the world, and what the autopilot believed and did.

use crate::aircraft::arcade::{Arbitration, Beat, Flight, Inertial, Motors, World};
use mcap::{Message, MessageStream};
use prost::Message as _;
use std::path::Path;

/// The messages of a flight, in the order in which they were sent.
pub(super) struct Recording {
    pub(super) world: Vec<World>,
    pub(super) flight: Vec<Flight>,
    pub(super) arbitration: Vec<Arbitration>,
    pub(super) beats: Vec<Numbered>,
    /// Times of the inertial readings.
    pub(super) readings: Vec<u64>,
    /// Times of the set-points.
    pub(super) motors: Vec<u64>,
}

/// A beat of the control loop. The number is counted from 0 when the autopilot started.
#[derive(Clone, Copy)]
pub(super) struct Numbered {
    pub(super) number: u32,
    pub(super) beat: Beat,
}

impl Recording {
    pub(super) fn read(file: &Path) -> Self {
        let bytes = std::fs::read(file).unwrap();
        let mut recording = Self {
            world: Vec::new(),
            flight: Vec::new(),
            arbitration: Vec::new(),
            beats: Vec::new(),
            readings: Vec::new(),
            motors: Vec::new(),
        };
        for message in MessageStream::new(&bytes).unwrap() {
            recording.add(&message.unwrap());
        }
        recording
    }

    fn add(&mut self, message: &Message<'_>) {
        let data = message.data.as_ref();
        match message.channel.topic.as_str() {
            "/simulator/world" => self.world.push(World::decode(data).unwrap()),
            "/simulator/imu" => self.readings.push(Inertial::decode(data).unwrap().time_us),
            "/autopilot/motors" => self.motors.push(Motors::decode(data).unwrap().time_us),
            "/autopilot/flight" => self.flight.push(Flight::decode(data).unwrap()),
            "/autopilot/beats" => {
                self.beats.push(Numbered { number: message.sequence, beat: Beat::decode(data).unwrap() });
            }
            "/mission_arbiter/arbitration" => self.arbitration.push(Arbitration::decode(data).unwrap()),
            _ => {}
        }
    }

    /// The world at a time of the vehicle's clock: the newest of its states until then.
    pub(super) fn world_at(&self, time_us: u64) -> &World {
        &self.world[self.world.partition_point(|world| world.time_us <= time_us).saturating_sub(1)]
    }
}
