//! The last message of a latched gate on another host: for subscribers that start late or again, with its age.

use super::hosts::{Hosts, LONG, number, numbered, until};
use crate::wire::proxy::Weather;
use scl::Sub;
use scl::bytes::Bytes;
use std::time::Instant;

#[tokio::test]
async fn a_subscriber_that_starts_late_or_again_gets_the_last_message_and_its_age() {
    let hosts = Hosts::start().await;
    let mut sensor = hosts.board.open("sensor").await;
    let mut mode = sensor.publisher("mode").unwrap();
    let before = Instant::now();
    for sent in 0..3 {
        mode.send(&numbered(sent)).await.unwrap();
    }
    let sent = Instant::now();
    for round in 0..4 {
        let waited = sent.elapsed();
        let mut controller = hosts.ground.open("controller").await;
        let mut received = controller.subscriber("mode").unwrap();
        // Once, also where the far host has not noticed yet that it has started again.
        let expected = if round == 0 { vec![(0, false), (1, false), (2, true)] } else { vec![(2, true)] };
        for expected in expected {
            assert_eq!(next(&mut received).await, expected, "round {round}");
        }
        // The publisher's clock is the one that counts.
        let age = received.latched_age().unwrap();
        assert!(waited <= age && age <= before.elapsed(), "round {round}: {waited:?} {age:?}");
        let mut newest = controller.subscriber("newest_mode").unwrap();
        assert_eq!(next(&mut newest).await, (2, true), "round {round}");
    }
    let mut controller = hosts.ground.open("controller").await;
    let mut received = controller.subscriber("mode").unwrap();
    assert_eq!(next(&mut received).await, (2, true));
    mode.send(&numbered(3)).await.unwrap();
    assert_eq!(next(&mut received).await, (3, false), "it was there when this was sent");
    let stats = mode.peer_stats().remove(0);
    assert_eq!(stats.published, stats.taken + stats.replaced + stats.lost + stats.waiting, "{stats:?}");
}

#[tokio::test]
async fn a_subscriber_that_runs_while_the_link_is_lost_gets_each_message_once() {
    let hosts = Hosts::with_proxy().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut mode, mut received) = (sensor.publisher("mode").unwrap(), controller.subscriber("mode").unwrap());
    until("the controller is there", || mode.is_connected()).await;
    mode.send(&numbered(0)).await.unwrap();
    assert_eq!(next(&mut received).await, (0, false));
    for round in 1..4 {
        hosts.set_weather(Weather::Cut);
        until("the link is lost", || !received.is_connected() && !mode.is_connected()).await;
        hosts.set_weather(Weather::Good);
        until("the link is there", || received.is_connected() && mode.is_connected()).await;
        mode.send(&numbered(round)).await.unwrap();
        assert_eq!(next(&mut received).await, (round, false), "nothing comes again");
    }
    // What was sent while the link was lost comes once, and is old.
    hosts.set_weather(Weather::Cut);
    until("the link is lost", || !received.is_connected() && !mode.is_connected()).await;
    mode.send(&numbered(9)).await.unwrap();
    hosts.set_weather(Weather::Good);
    assert_eq!(next(&mut received).await, (9, true));
    mode.send(&numbered(10)).await.unwrap();
    assert_eq!(next(&mut received).await, (10, false));
}

#[tokio::test]
async fn a_subscriber_that_starts_again_while_the_link_is_lost_gets_the_last_message() {
    let hosts = Hosts::with_proxy().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut mode, mut received) = (sensor.publisher("mode").unwrap(), controller.subscriber("mode").unwrap());
    until("the controller is there", || mode.is_connected()).await;
    mode.send(&numbered(0)).await.unwrap();
    assert_eq!(next(&mut received).await, (0, false));
    for _ in 0..3 {
        hosts.set_weather(Weather::Cut);
        until("the link is lost", || !received.is_connected() && !mode.is_connected()).await;
        drop(received);
        controller.close(LONG).await.unwrap();
        controller = hosts.ground.open("controller").await;
        received = controller.subscriber("mode").unwrap();
        hosts.set_weather(Weather::Good);
        assert_eq!(next(&mut received).await, (0, true));
    }
}

#[tokio::test]
async fn gateways_that_start_again_have_the_last_message_sent_again() {
    let mut hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut mode, mut received) = (sensor.publisher("mode").unwrap(), controller.subscriber("mode").unwrap());
    until("the controller is there", || mode.is_connected()).await;
    mode.send(&numbered(0)).await.unwrap();
    assert_eq!(next(&mut received).await, (0, false));
    for name in ["ground", "board"] {
        hosts.stop_gateway(name).await;
        hosts.start_gateway(name).await;
        assert_eq!(next(&mut received).await, (0, true), "{name}");
    }
}

/// The number of the next message, and whether it is latched.
async fn next(gate: &mut Sub<Bytes>) -> (u32, bool) {
    let received = tokio::time::timeout(LONG, gate.recv()).await.expect("a message").unwrap();
    (number(&received), gate.latched_age().is_some())
}
