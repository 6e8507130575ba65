//! The guarantees of a transport.
//!
//! Every end gets a waker of its own and is only called again when that one was woken, so a wake-up that gets lost
//! shows in each of these tests.

mod call;
mod flow;
mod pace;
mod watched;

pub use call::{
    answers_who_asked_in_any_order, carries_requests_of_every_size, finds_the_replier_that_stays,
    gives_back_what_nobody_answers, numbers_old_answers, survives_a_lost_requester, tells_of_a_lost_replier,
};
pub use flow::{
    carries_every_size, finds_the_peer_that_stays, frees_its_endpoint, gives_back_what_nobody_takes, keeps_order,
    keeps_what_is_flushed, lets_go_of_who_came_early, reports_a_late_peer, serves_every_pusher,
    serves_the_next_receiver, serves_the_next_sender,
};
pub use pace::{stays_quiet_when_idle, stops_and_resumes};

use crate::transport::{Inlet, Outlet, Transport, TransportError};
use bytes::Bytes;
use watched::{Receiving, Sending};

const ENDPOINT: &str = "sensor.out--controller.in.1a2b3c4d";
const OTHER_ENDPOINT: &str = "sensor.other--controller.other.1a2b3c4d";
const SIZES: [usize; 7] = [0, 1, 255, 256, 70_000, 1 << 20, 0];

/// The two ways to send.
#[derive(Debug, Clone, Copy)]
enum Flow {
    PublishSubscribe,
    PushPull,
}

const FLOWS: [Flow; 2] = [Flow::PublishSubscribe, Flow::PushPull];

impl Flow {
    fn sender(self, transport: &dyn Transport, endpoint: &str) -> Sending {
        Sending::new(opened(match self {
            Self::PublishSubscribe => transport.publish(endpoint),
            Self::PushPull => transport.push(endpoint),
        }))
    }

    fn receiver(self, transport: &dyn Transport, endpoint: &str) -> Receiving {
        Receiving::new(opened(match self {
            Self::PublishSubscribe => transport.subscribe(endpoint),
            Self::PushPull => transport.pull(endpoint),
        }))
    }

    fn pair(self, transport: &dyn Transport, endpoint: &str) -> (Sending, Receiving) {
        (self.sender(transport, endpoint), self.receiver(transport, endpoint))
    }
}

fn opened<E>(end: Result<E, TransportError>) -> E {
    end.unwrap_or_else(|error| panic!("an end could not be opened: {error}"))
}

fn numbered(count: u32) -> Vec<Bytes> {
    (0..count).map(|number| Bytes::copy_from_slice(&number.to_be_bytes())).collect()
}

fn pattern(size: usize) -> Bytes {
    (0..size).map(|place| (place % 251) as u8).collect()
}

/// The type of a sending end, for [`Sending`].
type AnyOutlet = Box<dyn Outlet>;
/// The type of a receiving end, for [`Receiving`].
type AnyInlet = Box<dyn Inlet>;
