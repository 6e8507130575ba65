//! What SCL's own ends do with each other.

use super::ends::{answer, ask, connected, request};
use super::stage::{Stage, next, number, numbered, pattern};
use crate::transport::zeromq::TransportKind;
use crate::transport::{PeerKind, RequesterGone};
use bytes::Bytes;

const SIZES: [usize; 9] = [0, 1, 255, 256, 500, 70_000, 1 << 20, 5 << 20, 0];
const TRANSPORTS: [TransportKind; 2] = [TransportKind::Ipc, TransportKind::Tcp];

#[tokio::test]
async fn messages_of_every_size_arrive_in_order() {
    for kind in TRANSPORTS {
        for publishes in [true, false] {
            let stage = Stage::new(kind);
            let (mut sender, mut receiver) = match publishes {
                true => (stage.publisher(), stage.subscriber()),
                false => (stage.pusher(), stage.puller()),
            };
            sender.until_peers(1, &mut *receiver).await;
            assert_eq!(sender.peers[0].kind, PeerKind::Component);
            sender.queue(SIZES.map(pattern));
            for size in SIZES {
                assert!(sender.during(next(&mut *receiver)).await == pattern(size), "{kind:?}, {size} bytes");
            }
            sender.queue(numbered(0..3000));
            for expected in 0..3000 {
                assert_eq!(number(&sender.during(next(&mut *receiver)).await), expected);
            }
            assert_eq!((receiver.peers(), receiver.malformed()), (1, 0));
        }
    }
}

#[tokio::test]
async fn a_lost_peer_is_noticed_and_the_next_one_is_found() {
    for publishes in [true, false] {
        let stage = Stage::new(TransportKind::Ipc);
        let open_sender = || if publishes { stage.publisher() } else { stage.pusher() };
        let open_receiver = || if publishes { stage.subscriber() } else { stage.puller() };
        let (mut sender, mut receiver) = (open_sender(), open_receiver());
        for _ in 0..5 {
            sender.until_peers(1, &mut *receiver).await;
            drop(receiver);
            sender.until(|sender| sender.peers.is_empty()).await;
            receiver = open_receiver();
        }
        for _ in 0..5 {
            drop(sender);
            sender = open_sender();
            sender.until_peers(1, &mut *receiver).await;
            sender.queue(numbered(7..8));
            assert_eq!(number(&sender.during(next(&mut *receiver)).await), 7);
        }
    }
}

#[tokio::test]
async fn several_pushers_are_served_in_turn() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut puller = stage.puller();
    let mut pushers = [stage.pusher(), stage.pusher()];
    for pusher in &mut pushers {
        pusher.until_peers(1, &mut *puller).await;
    }
    for pusher in &mut pushers {
        pusher.queue(numbered(0..200));
        pusher.until(|pusher| pusher.peers[0].queue.is_empty()).await;
    }
    let mut received = Vec::new();
    for _ in 0..400 {
        let message = pushers[0].during(next(&mut *puller)).await;
        received.push(number(&message));
    }
    // Neither is served to its end before the other gets its turn.
    let zeros: Vec<_> = received.iter().enumerate().filter(|(_, number)| **number == 0).map(|(at, _)| at).collect();
    assert!(zeros[1] <= 100, "{zeros:?}");
}

#[tokio::test]
async fn replies_find_their_requests_in_any_order() {
    for kind in TRANSPORTS {
        let stage = Stage::new(kind);
        let mut replier = stage.replier();
        let mut requesters = [stage.requester(), stage.requester()];
        for requester in &mut requesters {
            connected(&mut **requester, &mut *replier).await;
            for (id, size) in (0..).zip(SIZES) {
                ask(&mut **requester, id, pattern(size)).await;
                let request = request(&mut **requester, &mut *replier).await;
                assert!(request.body == pattern(size), "{kind:?}, {size} bytes");
                assert_eq!(request.path.reply(&request.envelope, request.body), Ok(()));
                let answer = answer(&mut **requester, &mut *replier).await;
                assert!(answer == Some((id, pattern(size))), "{kind:?}, {size} bytes");
            }
        }
        let mut requests = Vec::new();
        for requester in &mut requesters {
            for id in [u64::MAX, 0] {
                ask(&mut **requester, id, Bytes::from_static(b"later")).await;
                requests.push(request(&mut **requester, &mut *replier).await);
            }
        }
        for request in requests.into_iter().rev() {
            assert_eq!(request.path.reply(&request.envelope, request.body), Ok(()));
        }
        for requester in &mut requesters {
            for id in [0, u64::MAX] {
                assert_eq!(answer(&mut **requester, &mut *replier).await.map(|answer| answer.0), Some(id));
            }
        }
    }
}

#[tokio::test]
async fn a_lost_replier_is_reported_once_and_the_next_one_found() {
    let stage = Stage::new(TransportKind::Ipc);
    let mut requester = stage.requester();
    for id in 0..5 {
        let mut replier = stage.replier();
        connected(&mut *requester, &mut *replier).await;
        ask(&mut *requester, id, Bytes::from_static(b"?")).await;
        let unanswered = request(&mut *requester, &mut *replier).await;
        drop(replier);
        let mut bystander = Stage::new(TransportKind::Ipc).replier();
        assert_eq!(answer(&mut *requester, &mut *bystander).await, None);
        assert!(!requester.is_connected());
        assert_eq!(unanswered.path.reply(&unanswered.envelope, Bytes::new()), Err(RequesterGone));
    }
}
