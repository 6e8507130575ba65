//! `max_size`: a longer message is refused where it is sent, and a peer that sends one all the same is disconnected.

use scl::TransportKind;
use scl::bytes::Bytes;
use scl_tests::zmtp::{announcement, frame, message};
use scl_tests::{RawPeer, System};

scl::topology!("topologies/limits.yaml");

const LIMITS: [(&str, &str, usize); 2] = [("taker.jobs.", "PUSH", 3072), ("taker.answer.", "REQ", 4096)];

async fn pair(system: &System) -> (Giver, Taker) {
    let giver = Giver::open_with(system.options()).await.expect("open");
    let taker = Taker::open_with(system.options()).await.expect("open");
    (giver, taker)
}

fn bytes(length: usize) -> Bytes {
    Bytes::from(vec![7; length])
}

#[tokio::test]
async fn a_message_of_the_longest_length_arrives() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let system = System::over(kind);
        let (mut giver, mut taker) = pair(&system).await;
        giver.values.send(&bytes(2048)).await.expect("sent");
        assert_eq!(taker.values.recv().await.expect("received").len(), 2048);
        giver.jobs.send(&bytes(3072)).await.expect("pushed");
        assert_eq!(taker.jobs.recv().await.expect("pulled").len(), 3072);
        let request = bytes(4096);
        let (reply, ()) = tokio::join!(giver.question.call(&request), async {
            let request = taker.answer.recv().await.expect("a request");
            assert_eq!(request.message().len(), 4096);
            request.reply(&bytes(1024)).expect("replied");
        });
        assert_eq!(reply.expect("a reply").len(), 1024);
    }
}

#[tokio::test]
async fn a_longer_message_is_refused_with_both_sizes_and_the_next_one_arrives() {
    let system = System::new();
    let (mut giver, mut taker) = pair(&system).await;
    let error = giver.values.send(&bytes(2049)).await.expect_err("too long").to_string();
    assert_names(&error, ["giver.values", "taker.values", "2049", "2048"]);
    let error = giver.values.try_send(&bytes(2049)).expect_err("too long").to_string();
    assert_names(&error, ["giver.values", "taker.values", "2049", "2048"]);
    giver.values.send(&bytes(5)).await.expect("sent");
    assert_eq!(taker.values.recv().await.expect("received").len(), 5);

    let error = giver.jobs.send(&bytes(3073)).await.expect_err("too long").to_string();
    assert_names(&error, ["giver.jobs", "taker.jobs", "3073", "3072"]);
    giver.jobs.send(&bytes(5)).await.expect("pushed");
    assert_eq!(taker.jobs.recv().await.expect("pulled").len(), 5);

    let error = giver.question.call(&bytes(4097)).await.expect_err("too long").to_string();
    assert_names(&error, ["giver.question", "taker.answer", "4097", "4096"]);
    let request = bytes(5);
    let (reply, ()) = tokio::join!(giver.question.call(&request), async {
        let request = taker.answer.recv().await.expect("a request");
        request.reply(&bytes(6)).expect("replied");
    });
    assert_eq!(reply.expect("a reply").len(), 6);
}

#[tokio::test]
async fn a_longer_reply_is_refused_with_both_sizes() {
    let system = System::new();
    let (mut giver, mut taker) = pair(&system).await;
    let request = bytes(5);
    tokio::select! {
        _ = giver.question.call(&request) => unreachable!("there is no reply"),
        request = taker.answer.recv() => {
            let error = request.expect("a request").reply(&bytes(1025)).expect_err("too long").to_string();
            assert_names(&error, ["taker.answer", "giver.question", "1025", "1024"]);
        }
    }
}

/// The peer's program may know nothing about the limit: it is checked before memory is reserved.
#[tokio::test(flavor = "multi_thread")]
async fn a_peer_that_sends_a_longer_message_is_disconnected() {
    for kind in [TransportKind::Ipc, TransportKind::Tcp] {
        let system = System::over(kind);
        let (_giver, mut taker) = pair(&system).await;
        for (endpoint, socket_type, limit) in LIMITS {
            let address = system.address("limits", endpoint);
            let mut peer = RawPeer::join(&address, socket_type);
            let _closed = peer.send(&announcement(0, limit as u64 + 1));
            peer.wait_until_closed();
            // The length of an envelope counts as well.
            let mut peer = RawPeer::join(&address, socket_type);
            let _closed = peer.send(&[frame(1, b""), announcement(0, limit as u64 + 1)].concat());
            peer.wait_until_closed();
        }
        let mut pusher = RawPeer::join(&system.address("limits", LIMITS[0].0), "PUSH");
        pusher.send(&message(&[&vec![7; LIMITS[0].2]])).expect("sent");
        assert_eq!(taker.jobs.recv().await.expect("pulled").len(), LIMITS[0].2);
    }
}

#[track_caller]
fn assert_names(error: &str, words: [&str; 4]) {
    for word in words {
        assert!(error.contains(word), "`{word}` is not in: {error}");
    }
}
