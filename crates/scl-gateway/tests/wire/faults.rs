//! A bad link: cut, stalled, slow, late.

use std::time::Duration;

use bytes::Bytes;
use scl_gateway::wire::{Neighbour, ReceiverEvent, SenderEvent, Wire};

use super::network::*;
use super::proxy::{Proxy, Weather};

async fn with_proxy() -> (Wire, Wire, Proxy) {
    let address = free_address();
    let proxy = Proxy::to(&address).await;
    let (board, ground) = two_hosts_via(&address, &proxy.address).await;
    (board, ground, proxy)
}

#[tokio::test]
async fn a_cut_link_loses_and_duplicates_nothing() {
    let (board, ground, proxy) = with_proxy().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    let messages = numbered(1000);
    let receiving = async {
        let mut arrived = Vec::new();
        let mut matches = 0;
        while arrived.len() < 1000 {
            match received(&mut receiver).await {
                ReceiverEvent::Message(message) => {
                    arrived.push(message);
                    receiver.acknowledge(arrived.len() as u64);
                    // Not so late that all others may be on their way: the link would stay cut.
                    if [300, 600].contains(&arrived.len()) {
                        proxy.set(Weather::Cut);
                    }
                }
                ReceiverEvent::Unmatched => proxy.set(Weather::Good),
                ReceiverEvent::Matched => matches += 1,
                event => panic!("{event:?}"),
            }
        }
        (arrived, matches)
    };
    let (given_up, (arrived, matches)) = tokio::join!(send_all(&mut sender, messages.clone()), receiving);
    assert!(arrived == messages);
    assert_eq!(given_up, 0);
    assert!(matches >= 2, "the link was never cut");
}

#[tokio::test]
async fn a_stalled_link_is_noticed_and_what_was_sent_before_arrives_after_it() {
    let (board, ground, proxy) = with_proxy().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    proxy.set(Weather::Stalled);
    let messages = numbered(4);
    for message in &messages {
        sender.send(message.clone());
    }
    assert_eq!(sent(&mut sender).await, SenderEvent::Unmatched);
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Unmatched);
    assert_eq!(sender.unacknowledged(), 4);
    proxy.set(Weather::Good);
    let (given_up, arrived) = tokio::join!(send_all(&mut sender, []), receive(&mut receiver, 4));
    assert_eq!(given_up, 0);
    assert!(arrived == messages);
}

#[tokio::test]
async fn a_receiver_that_reopened_meanwhile_gets_nothing_of_before() {
    let (board, ground, proxy) = with_proxy().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    for message in numbered(3) {
        sender.send(message);
    }
    for _ in 0..3 {
        assert!(matches!(received(&mut receiver).await, ReceiverEvent::Message(_)));
    }
    proxy.set(Weather::Cut);
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Unmatched);
    assert_eq!(sent(&mut sender).await, SenderEvent::Unmatched);
    receiver.set_open(false);
    receiver.set_open(true);
    proxy.set(Weather::Good);
    assert_eq!(sent(&mut sender).await, SenderEvent::Matched);
    assert_eq!(sent(&mut sender).await, SenderEvent::GivenUp(3));
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Matched);
    sender.send(Bytes::from_static(b"new"));
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Message(Bytes::from_static(b"new")));
}

#[tokio::test]
async fn a_link_below_the_data_rate_loses_nothing_and_stays_fair() {
    let (board, ground, proxy) = with_proxy().await;
    let (mut images, mut image_end) = connected(&route("board", "ground", "image"), &board, &ground).await;
    let (mut poses, mut pose_end) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    proxy.set(Weather::Throttled(400_000));
    let image: Vec<_> = (0..2).map(|number| Bytes::from(vec![number; 600_000])).collect();
    let small = numbered(5);
    let mut images_left = 2;
    let large = async {
        let arrived = receive(&mut image_end, 2).await;
        images_left = 0;
        arrived
    };
    let (_, _, large, (arrived, is_fair)) =
        tokio::join!(send_all(&mut images, image.clone()), send_all(&mut poses, small.clone()), large, async {
            let arrived = receive(&mut pose_end, 5).await;
            (arrived, image_end_is_behind(&ground))
        });
    assert!(large == image);
    assert!(arrived == small);
    assert!(is_fair);
    // More was never given to the network library than it holds.
    assert_eq!((images.losses(), poses.losses()), (0, 0));
}

/// The link is still there: a slow one must not be taken for a dead one.
fn image_end_is_behind(ground: &Wire) -> bool {
    let cx = &mut std::task::Context::from_waker(std::task::Waker::noop());
    while let std::task::Poll::Ready(event) = ground.poll_neighbour(cx) {
        if matches!(event, Neighbour::Disconnected { .. }) {
            return false;
        }
    }
    true
}

#[tokio::test]
async fn a_late_link_delivers_in_order() {
    let (board, ground, proxy) = with_proxy().await;
    proxy.set(Weather::Delayed(Duration::from_millis(100)));
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    let messages = numbered(200);
    let (given_up, arrived) = tokio::join!(send_all(&mut sender, messages.clone()), receive(&mut receiver, 200));
    assert_eq!(given_up, 0);
    assert!(arrived == messages);
}

#[tokio::test]
async fn a_host_that_starts_later_or_again_is_found() {
    let address = free_address();
    let board = Wire::open(options("board", None, &[("ground", Some(&address))])).await.expect("board");
    let route = route("board", "ground", "pose");
    let mut sender = board.sender(&route);
    sender.set_open(true);
    for _ in 0..2 {
        let ground = Wire::open(options("ground", Some(&address), &[("board", None)])).await.expect("ground");
        let mut receiver = ground.receiver(&route);
        receiver.set_open(true);
        let (given_up, arrived) = tokio::join!(send_all(&mut sender, numbered(10)), receive(&mut receiver, 10));
        assert!(arrived == numbered(10) && given_up == 0);
        drop(receiver);
        ground.close().await;
        assert_eq!(sent(&mut sender).await, SenderEvent::Unmatched);
    }
}
