//! Messages between components of two hosts, with the queues that the topology declares.

use super::hosts::{Hosts, LONG, number, numbered, until};
use std::collections::BTreeSet;
use std::pin::pin;
use std::time::Duration;

/// Long enough for what must not happen, on a usual machine.
const SHORT: Duration = Duration::from_millis(300);

#[tokio::test]
async fn messages_arrive_in_order_and_waiting_loses_none() {
    let hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    let (sensor_ready, controller_ready) = tokio::join!(sensor.ready(LONG), controller.ready(LONG));
    sensor_ready.unwrap();
    controller_ready.unwrap();
    let sending = async {
        for sent in 0..1000 {
            samples.send(&numbered(sent)).await.unwrap();
        }
    };
    let receiving = async {
        for expected in 0..1000 {
            assert_eq!(number(&received.recv().await.unwrap()), expected);
        }
    };
    tokio::join!(sending, receiving);
}

#[tokio::test]
async fn a_publisher_waits_for_a_subscriber_on_another_host() {
    let hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    sensor.ready(LONG).await.unwrap();
    // The queue of the controller, that of the sensor, and one window of as many messages on each of three ways.
    const MOST: u32 = 4 * 5;
    let mut sent = 0;
    while sent <= MOST {
        let message = numbered(sent);
        if tokio::time::timeout(SHORT, samples.send(&message)).await.is_err() {
            break;
        }
        sent += 1;
    }
    assert!((4..=MOST).contains(&sent), "{sent} messages were sent to a component that takes none");
    for expected in 0..sent {
        assert_eq!(number(&received.recv().await.unwrap()), expected);
    }
}

#[tokio::test]
async fn a_pusher_gets_ready_while_another_waits_for_the_far_puller() {
    let hosts = Hosts::start().await;
    let (mut camera, mut controller) = (hosts.board.open("camera").await, hosts.ground.open("controller").await);
    let (mut first, mut received) = (camera.pusher("work").unwrap(), controller.puller("work").unwrap());
    camera.ready(LONG).await.unwrap();
    let mut sent = 0;
    while tokio::time::timeout(SHORT, first.send(&numbered(sent))).await.is_ok() {
        sent += 1;
    }
    let sensor = hosts.board.open("sensor").await;
    sensor.ready(LONG).await.unwrap();
    controller.ready(LONG).await.unwrap();
    for expected in 0..sent {
        assert_eq!(number(&received.recv().await.unwrap()), expected);
    }
}

#[tokio::test]
async fn a_queue_of_one_gets_the_newest_message() {
    let hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut newest, mut received) = (sensor.publisher("newest").unwrap(), controller.subscriber("newest").unwrap());
    sensor.ready(LONG).await.unwrap();
    for sent in 0..1000 {
        newest.send(&numbered(sent)).await.unwrap();
    }
    let mut last = None;
    while last != Some(999) {
        let next = number(&received.recv().await.unwrap());
        assert!(last < Some(next), "{next} after {last:?}");
        last = Some(next);
    }
    until("everything is accounted for", || newest.peer_stats()[0].waiting == 0).await;
    let stats = &newest.peer_stats()[0];
    assert_eq!((stats.published, stats.lost), (1000, 0));
    assert_eq!(stats.taken + stats.replaced, 1000);
}

#[tokio::test]
async fn pushers_share_pullers_across_hosts() {
    let hosts = Hosts::start().await;
    let (mut sensor, mut camera) = (hosts.board.open("sensor").await, hosts.board.open("camera").await);
    let (mut controller, mut assistant) = (hosts.ground.open("controller").await, hosts.ground.open("assistant").await);
    let (mut from_sensor, mut from_camera) = (sensor.pusher("work").unwrap(), camera.pusher("work").unwrap());
    let (mut first, mut second) = (controller.puller("work").unwrap(), assistant.puller("work").unwrap());
    sensor.ready(LONG).await.unwrap();
    camera.ready(LONG).await.unwrap();
    until("both pullers are connected", || from_sensor.stats().peers == 2).await;
    let sending = async {
        for sent in 0..300 {
            from_sensor.send(&numbered(sent)).await.unwrap();
            from_camera.send(&numbered(1000 + sent)).await.unwrap();
        }
    };
    let receiving = async {
        let (mut arrived, mut by_second) = (BTreeSet::new(), 0);
        while arrived.len() < 600 {
            let message = tokio::select! {
                message = first.recv() => message,
                message = second.recv() => {
                    by_second += 1;
                    message
                }
            };
            assert!(arrived.insert(number(&message.unwrap())), "a message arrived twice");
        }
        assert!(by_second > 0, "the second puller got nothing");
        arrived
    };
    let ((), arrived) = tokio::join!(sending, receiving);
    assert_eq!(arrived, (0..300).chain(1000..1300).collect());
}

#[tokio::test]
async fn a_flush_ends_when_the_far_component_has_taken_everything() {
    let hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    sensor.ready(LONG).await.unwrap();
    for sent in 0..8 {
        samples.send(&numbered(sent)).await.unwrap();
    }
    drop(samples);
    let mut closing = pin!(sensor.close(LONG));
    // The controller's queue holds four of them, so not all are taken.
    let early = tokio::time::timeout(SHORT, closing.as_mut()).await;
    assert!(early.is_err(), "closed although the far component has not taken everything");
    let receiving = async {
        for expected in 0..8 {
            assert_eq!(number(&received.recv().await.unwrap()), expected);
        }
    };
    let (closed, ()) = tokio::join!(closing, receiving);
    closed.unwrap();
}
