//! When messages were sent.

use super::stage::{Stage, newest_only, number, numbered, once};
use crate::transport::zeromq::TransportKind;
use crate::transport::{Endpoint, Frame, Transport};
use std::collections::VecDeque;
use std::task::Poll;
use std::time::{Duration, Instant};

#[tokio::test]
async fn a_message_comes_with_the_time_that_its_sender_tells() {
    for publishes in [true, false] {
        for ahead in [true, false] {
            let stage = Stage::new(TransportKind::Ipc);
            let endpoint = if ahead { newest_only() } else { super::stage::endpoint() };
            times_arrive(&stage, publishes, &endpoint).await;
        }
    }
}

async fn times_arrive(stage: &Stage, publishes: bool, endpoint: &Endpoint) {
    let (mut sender, mut receiver) = match publishes {
        true => (stage.publisher(), stage.transport.subscribe(endpoint).unwrap()),
        false => (stage.pusher(), stage.transport.pull(endpoint).unwrap()),
    };
    sender.until_peers(1, &mut *receiver).await;
    for round in 0..3 {
        let started = Instant::now();
        // Ten seconds ago, nine, eight and so on.
        let before = |number: u32| started - Duration::from_secs(u64::from(10 - number));
        let mut queue: VecDeque<Frame> = numbered(0..5).map(Frame::from).collect();
        let mut times: VecDeque<Instant> = (0..5).map(before).collect();
        let mut untimed: VecDeque<Frame> = numbered(5..6).map(Frame::from).collect();
        let mut expected = 0;
        while expected < 6 {
            once(|cx| {
                let driven = sender.link().drive(cx).unwrap();
                sender.link().send_all_timed(cx, Some(driven), &mut queue, &mut times, &mut |_| {});
                if queue.is_empty() {
                    sender.link().send_all(cx, None, &mut untimed, &mut |_| {});
                }
            })
            .await;
            if endpoint.newest_only {
                receiver.catch_up(Duration::ZERO);
            }
            while let Poll::Ready(message) = once(|cx| receiver.poll_recv(cx)).await {
                assert_eq!(number(&message), expected, "in round {round}");
                let told = receiver.take_sent();
                assert_eq!(told.is_none(), expected == 5, "{expected} in round {round}");
                if let Some(sent) = told {
                    // The time between two readings of the clock makes it earlier.
                    let before = before(expected);
                    assert!(sent <= before && before - sent <= started.elapsed(), "{expected} in round {round}");
                }
                expected += 1;
            }
            assert!(started.elapsed() < Duration::from_secs(300), "{expected} have come in round {round}");
            tokio::task::yield_now().await;
        }
    }
}
