//! Components of unit tests beside their counterparts.

use super::{LONG, bytes, plan, system_plan};
use scl::plan::Plan;
use scl::untyped::Component;
use std::time::Duration;

#[test]
fn what_was_sent_can_be_received_at_once() {
    for number in 0..20 {
        let (mut controller, mut peer) = Component::test_blocking(&plan("controller")).unwrap();
        assert_eq!(peer.spec().name, "controller's peers");
        let (mut from, mut to) = (peer.publisher("sensor").unwrap(), controller.subscriber("sensor").unwrap());
        from.send_blocking(&bytes(&number.to_string())).unwrap();
        assert_eq!(to.try_recv().unwrap().unwrap(), number.to_string());
        let (mut from, mut to) = (peer.pusher("work").unwrap(), controller.puller("work").unwrap());
        from.send_blocking(&bytes("job")).unwrap();
        assert_eq!(to.recv_blocking().unwrap(), "job");
    }
}

#[test]
fn requests_go_both_ways() {
    for component in ["sensor", "controller"] {
        let (mut tested, mut peer) = Component::test_blocking(&plan(component)).unwrap();
        let (asks, answers) = if component == "sensor" { (&mut peer, &mut tested) } else { (&mut tested, &mut peer) };
        let (mut requester, mut replier) =
            (asks.requester("calibrate").unwrap(), answers.replier("calibrate").unwrap());
        let server = std::thread::spawn(move || {
            let request = replier.recv_blocking().unwrap();
            assert_eq!(*request, "question");
            request.reply(&bytes("answer")).unwrap();
        });
        assert_eq!(requester.call_blocking(&bytes("question")).unwrap(), "answer");
        server.join().unwrap();
    }
}

#[tokio::test(start_paused = true)]
async fn async_components_are_connected_too() {
    let before = tokio::time::Instant::now();
    let (mut sensor, mut peer) = Component::test(&plan("sensor")).await.unwrap();
    let (mut from, mut to) = (sensor.publisher("measurements").unwrap(), peer.subscriber("measurements").unwrap());
    assert!(from.is_connected() && to.is_connected());
    from.send(&bytes("1")).await.unwrap();
    assert_eq!(to.recv().await.unwrap(), "1");
    assert_eq!(before.elapsed(), Duration::ZERO, "the paused clock stood still");
    sensor.close(LONG).await.unwrap();
    peer.close(LONG).await.unwrap();
}

/// A gate with two peers, one of which makes it wait: all peers are the one counterpart.
#[test]
fn several_peers_are_one_counterpart() {
    let gate = |name: &str| -> Plan {
        let mut plan = system_plan("untyped.yaml").component("sensor").unwrap().clone();
        let gate = plan.gates.iter_mut().find(|gate| gate.name == name).unwrap();
        let second = scl::plan::ConnectionPlan {
            peer_component: "recorder".to_owned(),
            endpoint: "elsewhere".to_owned(),
            queue: 1,
            when_full: scl::plan::WhenFull::Wait,
            ..gate.connections[0].clone()
        };
        gate.options.backpressure = true;
        gate.connections.push(second);
        plan
    };
    let (mut sensor, mut peer) = Component::test_blocking(&gate("measurements")).unwrap();
    sensor.ready_blocking(Duration::ZERO).unwrap();
    let (mut from, mut to) = (sensor.publisher("measurements").unwrap(), peer.subscriber("measurements").unwrap());
    for number in 0..50 {
        from.send_timeout(&bytes(&number.to_string()), LONG).unwrap();
    }
    for number in 0..50 {
        assert_eq!(to.recv_timeout(LONG).unwrap(), number.to_string());
    }
}

/// A gate may lose messages unless its connection is declared lossless, so it is closed at once, whatever the peer has
/// taken.
#[test]
fn what_nobody_received_is_no_failure() {
    for _ in 0..20 {
        let (mut sensor, mut peer) = Component::test_blocking(&plan("sensor")).unwrap();
        let mut publisher = sensor.publisher("raw").unwrap();
        for _ in 0..200 {
            publisher.send_blocking(&bytes("unread")).unwrap();
        }
        drop(publisher);
        sensor.close_blocking(Duration::ZERO).unwrap();
        let mut subscriber = peer.subscriber("raw").unwrap();
        assert_eq!(subscriber.try_recv().unwrap().unwrap(), "unread");
        drop(subscriber);
        peer.close_blocking(Duration::ZERO).unwrap();
    }
}

/// The peer's gate takes all messages, whether its program receives them or not.
#[test]
fn a_lossless_connection_is_flushed_when_the_gate_of_the_peer_has_everything() {
    let (mut sensor, mut peer) = Component::test_blocking(&plan("sensor")).unwrap();
    let mut publisher = sensor.publisher("measurements").unwrap();
    for _ in 0..200 {
        publisher.send_blocking(&bytes("unread")).unwrap();
    }
    drop(publisher);
    let mut subscriber = peer.subscriber("measurements").unwrap();
    assert_eq!(subscriber.recv_blocking().unwrap(), "unread");
    sensor.close_blocking(LONG).unwrap();
    drop(subscriber);
    peer.close_blocking(Duration::ZERO).unwrap();
}

#[test]
fn a_plan_that_contradicts_itself_is_refused() {
    let mut plan = plan("sensor");
    plan.gates[0].options.queue = 0;
    let error = scl::Error::from(Component::test_blocking(&plan).unwrap_err());
    assert!(format!("{error:?}").contains("has a queue of 0 messages"), "{error:?}");
}
