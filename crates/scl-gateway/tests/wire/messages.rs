//! Messages over a good link: order, credit, accounts.

use bytes::Bytes;
use scl_gateway::route::Route;
use scl_gateway::wire::{ReceiverEvent, SenderEvent};

use super::network::*;

#[tokio::test]
async fn messages_of_all_lengths_arrive_once_and_in_order() {
    let (board, ground) = two_hosts().await;
    let route = route("board", "ground", "image");
    let (mut sender, mut receiver) = connected(&route, &board, &ground).await;
    let messages = numbered(300);
    let (given_up, arrived) = tokio::join!(send_all(&mut sender, messages.clone()), receive(&mut receiver, 300));
    assert_eq!(given_up, 0);
    assert!(arrived == messages);
    board.close().await;
    ground.close().await;
}

#[tokio::test]
async fn a_message_larger_than_the_window_travels_alone() {
    let (board, ground) = two_hosts().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "image"), &board, &ground).await;
    let image = Bytes::from(vec![7; 4 << 20]);
    assert!(sender.may_send(image.len()));
    sender.send(image.clone());
    assert!(!sender.may_send(1));
    let (_, arrived) = tokio::join!(send_all(&mut sender, [Bytes::from_static(b"after")]), receive(&mut receiver, 2));
    assert!(arrived[0] == image);
    assert_eq!(&*arrived[1], b"after");
}

#[tokio::test]
async fn the_credit_is_the_queue_and_comes_back_as_messages_are_taken() {
    let (board, ground) = two_hosts().await;
    let route = Route { queue: 5, ..route("board", "ground", "pose") };
    let (mut sender, mut receiver) = connected(&route, &board, &ground).await;
    let mut sent_so_far = 0;
    while sender.may_send(8) {
        sent_so_far += 1;
        sender.send(Bytes::from_static(b"8 bytes."));
    }
    assert_eq!(sent_so_far, 5);
    for _ in 0..5 {
        assert!(matches!(received(&mut receiver).await, ReceiverEvent::Message(_)));
    }
    assert_eq!(sender.unacknowledged(), 5);
    receiver.acknowledge(2);
    assert_eq!(sent(&mut sender).await, SenderEvent::Acknowledged(2));
    assert!(sender.may_send(8));
    assert_eq!(sender.unacknowledged(), 3);
}

#[tokio::test]
async fn the_credit_is_at_most_64_messages_or_256_kib() {
    let (board, ground) = two_hosts().await;
    for (length, expected) in [(1, 64), (64 * 1024, 4)] {
        let route = Route { queue: 1000, ..route("board", "ground", &format!("pose{length}")) };
        let (mut sender, _receiver) = connected(&route, &board, &ground).await;
        let mut sent_so_far = 0;
        while sender.may_send(length) {
            sent_so_far += 1;
            sender.send(Bytes::from(vec![0; length]));
        }
        assert_eq!(sent_so_far, expected, "of {length} bytes");
    }
}

#[tokio::test]
async fn both_directions_at_once() {
    let (board, ground) = two_hosts().await;
    let (mut up, mut up_end) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    let (mut down, mut down_end) = connected(&route("ground", "board", "command"), &ground, &board).await;
    let messages = numbered(200);
    let (_, _, up, down) = tokio::join!(
        send_all(&mut up, messages.clone()),
        send_all(&mut down, messages.clone()),
        receive(&mut up_end, 200),
        receive(&mut down_end, 200),
    );
    assert!(up == messages && down == messages);
}

#[tokio::test]
async fn a_flush_asks_the_receiver() {
    let (board, ground) = two_hosts().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    sender.send(Bytes::from_static(b"last"));
    sender.request_acknowledgement();
    assert!(matches!(received(&mut receiver).await, ReceiverEvent::Message(_)));
    assert_eq!(received(&mut receiver).await, ReceiverEvent::AcknowledgementRequested);
    receiver.acknowledge(1);
    assert_eq!(sent(&mut sender).await, SenderEvent::Acknowledged(1));
}

#[tokio::test]
async fn another_opening_gives_up_and_begins_anew() {
    let (board, ground) = two_hosts().await;
    let (mut sender, mut receiver) = connected(&route("board", "ground", "pose"), &board, &ground).await;
    for message in numbered(3) {
        sender.send(message);
    }
    for _ in 0..3 {
        assert!(matches!(received(&mut receiver).await, ReceiverEvent::Message(_)));
    }
    receiver.acknowledge(1);
    assert_eq!(sent(&mut sender).await, SenderEvent::Acknowledged(1));
    receiver.set_open(false);
    assert_eq!(sent(&mut sender).await, SenderEvent::Unmatched);
    assert!(!sender.may_send(1));
    receiver.set_open(true);
    assert_eq!(sent(&mut sender).await, SenderEvent::Matched);
    assert_eq!(sent(&mut sender).await, SenderEvent::GivenUp(2));
    assert_eq!(sender.unacknowledged(), 0);
    sender.send(Bytes::from_static(b"new"));
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Message(Bytes::from_static(b"new")));
    receiver.acknowledge(1);
    assert_eq!(sent(&mut sender).await, SenderEvent::Acknowledged(4));
}

#[tokio::test]
async fn another_sender_begins_anew() {
    let (board, ground) = two_hosts().await;
    let route = route("board", "ground", "pose");
    let (mut sender, mut receiver) = connected(&route, &board, &ground).await;
    send_some(&mut sender, &mut receiver, 0).await;
    drop(sender);
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Unmatched);
    let mut sender = board.sender(&route);
    sender.set_open(true);
    assert_eq!(received(&mut receiver).await, ReceiverEvent::Matched);
    assert_eq!(sent(&mut sender).await, SenderEvent::Matched);
    send_some(&mut sender, &mut receiver, 5).await;
}

/// Five messages; `before` is how many this receiver has taken already.
async fn send_some(
    sender: &mut scl_gateway::wire::WireSender,
    receiver: &mut scl_gateway::wire::WireReceiver,
    before: u64,
) {
    let messages = numbered(5);
    let receiving = async {
        for (number, message) in messages.iter().enumerate() {
            assert_eq!(received(receiver).await, ReceiverEvent::Message(message.clone()));
            receiver.acknowledge(before + number as u64 + 1);
        }
    };
    tokio::join!(send_all(sender, messages.clone()), receiving);
}

#[tokio::test]
async fn three_hosts_and_200_routes_at_once() {
    let (ground_address, tower_address) = (free_address(), free_address());
    let (ground_address, tower_address) = (Some(&*ground_address), Some(&*tower_address));
    let board = options("board", None, &[("ground", ground_address), ("tower", tower_address)]);
    let ground = options("ground", ground_address, &[("board", None), ("tower", tower_address)]);
    let tower = options("tower", tower_address, &[("board", None), ("ground", ground_address)]);
    let mut wires = Vec::new();
    for options in [board, ground, tower] {
        wires.push(scl_gateway::wire::Wire::open(options).await.expect("open"));
    }
    let hosts = ["board", "ground", "tower"];
    let mut tasks = tokio::task::JoinSet::new();
    for number in 0..200 {
        let (from, to) = (number % 3, (number + 1 + number / 3 % 2) % 3);
        let route = route(hosts[from], hosts[to], &format!("gate{number}"));
        let (mut sender, mut receiver) = (wires[from].sender(&route), wires[to].receiver(&route));
        sender.set_open(true);
        receiver.set_open(true);
        let messages = numbered(20);
        let expected = messages.clone();
        tasks.spawn(async move { assert_eq!(send_all(&mut sender, messages).await, 0) });
        tasks.spawn(async move { assert!(receive(&mut receiver, 20).await == expected) });
    }
    let mut finished = 0;
    while let Some(outcome) = tasks.join_next().await {
        outcome.expect("a route failed");
        finished += 1;
    }
    assert_eq!(finished, 400);
}
