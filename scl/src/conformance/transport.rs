//! What SCL relies on in a transport, one function per guarantee.
//!
//! Each end has a separate waker and is called again only after it has used that waker, so a missed wake-up makes any
//! of these tests fail. They run on a current-thread runtime and on one with two worker threads.
//!
//! | file | guarantees about |
//! |---|---|
//! | `delivery` | messages that arrive complete, in order, once |
//! | `peers` | ends that connect in any order, and reconnect |
//! | `pace` | peers of different speed, acknowledgements, and idle ends |
//! | `freshness` | ends that want only the newest message |
//! | `detached` | calls without a runtime |
//! | `threads` | ends that are moved between tasks and threads |
//! | `loans` | memory that links lend |
//! | `declared` | what the transport declares, and what gates conclude from it |
//! | `requests` | requests and replies |

mod declared;
mod delivery;
mod detached;
mod ends;
mod freshness;
mod loans;
mod pace;
mod peers;
mod request_ends;
mod requests;
mod threads;
mod watched;

pub use declared::{counts_what_was_not_taken, declares, tells_what_was_received, tells_who_waits};
pub use delivery::{
    carries_every_size, delivers_what_was_written, keeps_order, never_delivers_an_oversized_message,
    serves_every_pusher,
};
pub use detached::{
    accepts_peers_when_detached, delivers_after_its_runtime_has_ended, delivers_when_detached, replies_when_detached,
};
pub use freshness::{
    catches_up_with_a_busy_sender, catches_up_with_senders_that_answer_in_turn, catches_up_without_a_runtime,
    returns_the_newest_message,
};
pub use loans::{
    carries_loans, copies_loans_of_a_lost_link, leaves_loans_to_their_holder, lends_nothing,
    returns_loans_that_it_refuses, takes_dropped_loans_back,
};
pub use pace::{acknowledges_what_was_taken, keeps_subscribers_independent, stays_quiet_when_idle, stops_and_resumes};
pub use peers::{
    connects_only_if_the_check_passes, connects_without_room, counts_peers, counts_requesters,
    finds_the_peer_that_stays, frees_its_endpoint, reconnects_after_a_dropped_link, releases_an_idle_connection,
    requests_only_if_the_check_passes, serves_the_next_receiver, serves_the_next_sender, waits_for_a_late_peer,
    yields_each_peer_once,
};
pub use requests::{
    answers_in_any_order, carries_requests_of_every_size, delivers_written_replies, finds_the_replier_that_stays,
    keeps_request_numbers, never_delivers_an_oversized_request, refuses_requests_without_a_replier,
    reports_a_lost_replier, survives_a_lost_requester,
};
pub use threads::{moves_between_threads, moves_requests_between_threads};

use crate::transport::{Endpoint, Transport, TransportError};
use bytes::Bytes;
use ends::{TestReceiver, TestSender};
use std::future::poll_fn;
use std::task::{Context, Poll};

const ENDPOINT: &str = "sensor.out--controller.in.1a2b3c4d";
const OTHER_ENDPOINT: &str = "sensor.other--controller.other.1a2b3c4d";
const SIZES: [usize; 7] = [0, 1, 255, 256, 70_000, 1 << 20, 0];

/// The two patterns in which messages go one way.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pattern {
    PubSub,
    PushPull,
}

const PATTERNS: [Pattern; 2] = [Pattern::PubSub, Pattern::PushPull];

impl Pattern {
    fn sender(self, transport: &dyn Transport) -> TestSender {
        self.sender_at(transport, &Endpoint::new(ENDPOINT))
    }

    fn sender_at(self, transport: &dyn Transport, endpoint: &Endpoint) -> TestSender {
        TestSender::new(opened(match self {
            Self::PubSub => transport.publish(endpoint),
            Self::PushPull => transport.push(endpoint),
        }))
    }

    fn receiver(self, transport: &dyn Transport) -> TestReceiver {
        self.receiver_at(transport, &Endpoint::new(ENDPOINT))
    }

    fn receiver_at(self, transport: &dyn Transport, endpoint: &Endpoint) -> TestReceiver {
        TestReceiver::new(opened(match self {
            Self::PubSub => transport.subscribe(endpoint),
            Self::PushPull => transport.pull(endpoint),
        }))
    }

    /// Returns a sender and a receiver that are connected.
    async fn connected(self, transport: &dyn Transport) -> (TestSender, TestReceiver) {
        self.connected_to(transport, &Endpoint::new(ENDPOINT)).await
    }

    /// Returns a sender connected to a receiver that has the limits of `receiving`.
    async fn connected_to(self, transport: &dyn Transport, receiving: &Endpoint) -> (TestSender, TestReceiver) {
        let mut sender = self.sender_at(transport, &Endpoint::new(receiving.name.clone()));
        let mut receiver = self.receiver_at(transport, receiving);
        connect(&mut sender, &mut receiver).await;
        (sender, receiver)
    }
}

fn opened<E>(end: Result<E, TransportError>) -> E {
    end.unwrap_or_else(|error| panic!("an end could not be opened: {error}"))
}

/// Waits until the sender is connected, polling the receiver too.
async fn connect(sender: &mut TestSender, receiver: &mut TestReceiver) {
    poll_fn(|cx| {
        assert!(receiver.poll(cx).is_pending(), "received a message that was not sent");
        if sender.poll(cx) { Poll::Ready(()) } else { Poll::Pending }
    })
    .await;
}

/// Sends `messages` and a last one, and checks that exactly these arrive, in this order.
async fn check_carried(pattern: Pattern, sender: &mut TestSender, receiver: &mut TestReceiver, messages: &[Bytes]) {
    let last = Bytes::from_static(b"the last message");
    sender.queue(messages.iter().cloned().chain([last.clone()]));
    for (index, expected) in messages.iter().enumerate() {
        let message = receiver.next(&mut [sender]).await;
        let sizes = (message.len(), expected.len());
        assert!(message == *expected, "{pattern:?}: message {index} differs, sizes {sizes:?}: {message:.20?}");
    }
    assert_eq!(receiver.next(&mut [sender]).await, last, "{pattern:?}: received more than was sent");
}

/// Polls for a number of turns, letting other tasks run in between.
async fn turns(count: usize, mut poll: impl FnMut(&Context<'_>)) {
    for _ in 0..count {
        poll_fn(|cx| {
            poll(cx);
            Poll::Ready(())
        })
        .await;
        tokio::task::yield_now().await;
    }
}

fn numbered(count: u32) -> Vec<Bytes> {
    (0..count).map(|number| Bytes::copy_from_slice(&number.to_be_bytes())).collect()
}

/// Bytes with a pattern that shows whether some of them were lost or moved.
fn content(size: usize) -> Bytes {
    (0..size).map(|index| (index % 251) as u8).collect()
}
