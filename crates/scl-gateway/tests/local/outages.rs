//! The link between the hosts is lost, or a gateway ends: what waits is kept, and nothing arrives twice.

use super::hosts::{Hosts, LONG, number, numbered, until};
use crate::wire::proxy::Weather;
use std::pin::pin;

const MESSAGES: u32 = 600;

#[tokio::test]
async fn a_cut_link_loses_nothing_of_what_waits() {
    let hosts = Hosts::with_proxy().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    let mut camera = hosts.board.open("camera").await;
    let (mut work, mut pulled) = (camera.pusher("work").unwrap(), controller.puller("work").unwrap());
    sensor.ready(LONG).await.unwrap();
    let sending = async {
        for sent in 0..MESSAGES {
            samples.send(&numbered(sent)).await.unwrap();
        }
        until("everything is taken", || samples.peer_stats()[0].waiting == 0).await;
    };
    let pushing = async {
        for sent in 0..MESSAGES {
            work.send(&numbered(sent)).await.unwrap();
        }
        until("everything is taken", || work.peer_stats()[0].waiting == 0).await;
    };
    let pulling = async {
        for expected in 0..MESSAGES {
            assert_eq!(number(&pulled.recv().await.unwrap()), expected);
        }
    };
    let receiving = async {
        for expected in 0..MESSAGES {
            assert_eq!(number(&received.recv().await.unwrap()), expected);
            if expected % 200 == 100 {
                hosts.set_weather(Weather::Cut);
                until("the link is lost", || !received.is_connected()).await;
                hosts.set_weather(Weather::Good);
            }
        }
    };
    tokio::join!(sending, receiving, pushing, pulling);
    for stats in [&samples.peer_stats()[0], &work.peer_stats()[0]] {
        assert_eq!((stats.taken, stats.lost), (u64::from(MESSAGES), 0));
    }
    for (part, all) in [("samples", MESSAGES), ("work", MESSAGES)] {
        let [board, ground] = hosts.figures(part);
        assert_eq!((board, ground), ((u64::from(all), 0, 0), (u64::from(all), 0, 0)), "{part}");
    }
}

#[tokio::test]
async fn a_gateway_that_is_stopped_takes_nothing_with_it() {
    let mut hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    let sending = async {
        for sent in 0..MESSAGES {
            samples.send(&numbered(sent)).await.unwrap();
        }
        until("everything is taken", || samples.peer_stats()[0].waiting == 0).await;
        assert_eq!(samples.peer_stats()[0].lost, 0);
    };
    let receiving = async {
        for expected in 0..MESSAGES {
            assert_eq!(number(&received.recv().await.unwrap()), expected);
        }
    };
    let restarting = async {
        for name in ["board", "board", "board"] {
            sensor.ready(LONG).await.unwrap();
            hosts.stop_gateway(name).await;
            hosts.start_gateway(name).await;
        }
    };
    tokio::join!(sending, receiving, restarting);
}

#[tokio::test]
async fn what_another_gateway_of_the_far_host_may_miss_is_counted() {
    let mut hosts = Hosts::start().await;
    let (mut sensor, mut controller) = (hosts.board.open("sensor").await, hosts.ground.open("controller").await);
    let (mut samples, mut received) = (sensor.publisher("samples").unwrap(), controller.subscriber("samples").unwrap());
    let mut arrived = Vec::new();
    let sending = async {
        for sent in 0..MESSAGES {
            samples.send(&numbered(sent)).await.unwrap();
        }
        until("everything is taken", || samples.peer_stats()[0].waiting == 0).await;
        let stats = &samples.peer_stats()[0];
        assert_eq!((stats.taken, stats.lost), (u64::from(MESSAGES), 0));
    };
    let restarting = async {
        for _ in 0..3 {
            sensor.ready(LONG).await.unwrap();
            hosts.stop_gateway("ground").await;
            hosts.start_gateway("ground").await;
        }
    };
    {
        let mut all_sent = pin!(async { tokio::join!(sending, restarting) });
        loop {
            tokio::select! {
                message = received.recv() => arrived.push(number(&message.unwrap())),
                _ = &mut all_sent => break,
            }
        }
    }
    while let Some(message) = received.try_recv().unwrap() {
        arrived.push(number(&message));
    }
    assert!(arrived.is_sorted_by(|one, next| one < next), "in order, each at most once");
    let [board, _] = hosts.figures("samples");
    let arrived = arrived.len() as u64;
    assert_eq!((board.0 + board.1, board.2), (u64::from(MESSAGES), 0));
    assert_eq!(arrived + board.1, u64::from(MESSAGES), "what did not arrive was given up");
}
