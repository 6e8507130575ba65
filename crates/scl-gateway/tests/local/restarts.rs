//! Components that start again, on either side.

use super::hosts::{Hosts, LONG, number, numbered, until};

#[tokio::test]
async fn a_publisher_that_starts_again_is_found() {
    let hosts = Hosts::start().await;
    let mut controller = hosts.ground.open("controller").await;
    let mut received = controller.subscriber("samples").unwrap();
    for run in 0..4 {
        let mut sensor = hosts.board.open("sensor").await;
        let mut samples = sensor.publisher("samples").unwrap();
        sensor.ready(LONG).await.unwrap();
        for sent in 0..20 {
            let message = numbered(run * 100 + sent);
            let (sent_now, arrived) = tokio::join!(samples.send(&message), received.recv());
            sent_now.unwrap();
            assert_eq!(arrived.unwrap(), message);
        }
        drop(samples);
        sensor.close(LONG).await.unwrap();
    }
}

#[tokio::test]
async fn what_waits_for_a_subscriber_of_another_host_is_kept_until_it_starts_again() {
    let hosts = Hosts::start().await;
    let mut sensor = hosts.board.open("sensor").await;
    let mut samples = sensor.publisher("samples").unwrap();
    for run in 0..4 {
        let mut controller = hosts.ground.open("controller").await;
        let mut received = controller.subscriber("samples").unwrap();
        for expected in 0..4 {
            if run == 0 {
                samples.send(&numbered(expected)).await.unwrap();
            }
            assert_eq!(number(&received.recv().await.unwrap()), run * 4 + expected);
        }
        until("everything is acknowledged", || samples.peer_stats()[0].waiting == 0).await;
        drop((received, controller));
        until("the controller is gone", || !samples.is_connected()).await;
        // These wait in the sensor, as on one host.
        for sent in 0..4 {
            samples.send(&numbered((run + 1) * 4 + sent)).await.unwrap();
        }
        assert_eq!(samples.peer_stats()[0].waiting, 4);
    }
    assert_eq!(samples.peer_stats()[0].lost, 0);
}
