//! A recorded session: what is true of the band, what the application got, and when each part started.

use super::checks::Outage;
use crate::radio::ospecorr::{Service, Truth};
use mcap::{Message, MessageStream};
use prost::Message as _;
use scl_record::format::SIMULATION_START;
use scl_text::duration::nanoseconds;
use std::collections::HashMap;
use std::path::Path;
use std::time::Duration;

/// The messages of a session, in the order in which they were sent.
#[derive(Default)]
pub(super) struct Recording {
    pub(super) truth: Vec<Truth>,
    /// When each of them was sent, in nanoseconds since 1970.
    truth_ns: Vec<u64>,
    pub(super) service: Vec<Service>,
    /// The first message of each process of a component, and each reply of the resource map, at the time of the band.
    pub(super) starts: Vec<(String, u64)>,
    /// The newest number of each topic.
    sequences: HashMap<String, u32>,
}

impl Recording {
    pub(super) fn read(file: &Path) -> Self {
        let bytes = std::fs::read(file).unwrap();
        let mut recording = Self::default();
        for message in MessageStream::new(&bytes).unwrap() {
            recording.add(&message.unwrap());
        }
        recording
    }

    fn add(&mut self, message: &Message<'_>) {
        let data = message.data.as_ref();
        let topic = message.channel.topic.as_str();
        // The numbers begin again in each process. The recorder may miss the very first ones.
        let previous = self.sequences.insert(topic.to_owned(), message.sequence);
        let mut is_first = previous.is_none_or(|previous| message.sequence < previous);
        match topic {
            "/spectrum/truth" => {
                self.truth.push(Truth::decode(data).unwrap());
                self.truth_ns.push(message.publish_time);
            }
            "/application/service" => self.service.push(Service::decode(data).unwrap()),
            // One gate of each of the other parts.
            "/signal_detector/occupancy" | "/link_optimizer/link" | "/radio/state" => {}
            // Calls are counted by the requester, so any of them may be the first after a restart.
            "/resource_map/queries/reply" => is_first = true,
            _ => return,
        }
        if is_first {
            let component = topic.split('/').nth(1).unwrap();
            self.starts.push((component.to_owned(), self.now_us()));
        }
    }

    /// The time of the newest slot read.
    fn now_us(&self) -> u64 {
        self.truth.last().map_or(0, |truth| truth.time_us)
    }

    /// The band's clock at a time of a simulation, in seconds.
    pub(super) fn band_us(&self, at: f64) -> u64 {
        let at_ns = nanoseconds(SIMULATION_START + Duration::from_secs_f64(at));
        let before = self.truth_ns.partition_point(|sent| *sent <= at_ns);
        before.checked_sub(1).map_or(0, |index| self.truth[index].time_us)
    }

    /// The part of the time in which the application was served, from its first service on, without outages.
    pub(super) fn share_of_service(&self, outages: &[Outage]) -> f64 {
        let since_first = self.service.iter().skip_while(|it| !it.served);
        let counted: Vec<bool> = since_first
            .filter(|it| it.time_us > 0 && !outages.iter().any(|outage| outage.disturbs(it.time_us)))
            .map(|it| it.served)
            .collect();
        counted.iter().filter(|served| **served).count() as f64 / counted.len() as f64
    }
}
