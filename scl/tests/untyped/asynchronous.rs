//! The async and the non-waiting calls.

use super::{LONG, bytes, on_each_transport_async, plan};
use futures_core::Stream;
use futures_sink::Sink;
use scl::untyped::Component;
use scl::{OpenOptions, TrySendError};
use std::future::poll_fn;
use std::pin::Pin;
use std::time::Duration;

async fn open(options: OpenOptions) -> (Component, Component) {
    let sensor = Component::open_with(&plan("sensor"), options.clone()).await.unwrap();
    let controller = Component::open_with(&plan("controller"), options).await.unwrap();
    (sensor, controller)
}

#[test]
fn messages_are_published_and_received() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options).await;
        let (mut sends, mut receives) =
            (sensor.publisher("measurements").unwrap(), controller.subscriber("sensor").unwrap());
        assert_eq!(receives.try_recv().unwrap(), None);
        // Of gates that were taken, too.
        sensor.ready(LONG).await.unwrap();
        controller.ready(LONG).await.unwrap();
        assert!(sends.is_connected() && receives.is_connected());
        assert_eq!(sends.peers_changed().await, 1);

        sends.send(&bytes("[1.5]")).await.unwrap();
        assert_eq!(receives.recv().await.unwrap(), "[1.5]");
        sends.try_send(&bytes("not even JSON")).unwrap();
        assert_eq!(receives.recv().await.unwrap(), "not even JSON");
        let mut sink = Pin::new(&mut sends);
        poll_fn(|cx| sink.as_mut().poll_ready(cx)).await.unwrap();
        sink.as_mut().start_send(bytes("")).unwrap();
        poll_fn(|cx| sink.as_mut().poll_flush(cx)).await.unwrap();
        let streamed = poll_fn(|cx| Pin::new(&mut receives).poll_next(cx)).await;
        assert_eq!(streamed.unwrap().unwrap(), "");

        let (sent, received) = (sends.stats(), receives.stats());
        assert_eq!((sent.sent, sent.peers, received.received, received.rejected), (3, 1, 3, 0));
        let peers = sends.peer_stats();
        assert_eq!((peers.len(), peers[0].peer.as_str(), peers[0].published), (1, "controller.sensor", 3));
    });
}

#[test]
fn the_newest_message_is_found() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options).await;
        let mut sends = sensor.publisher("raw").unwrap();
        let mut receives = controller.subscriber("raw").unwrap();
        controller.ready(LONG).await.unwrap();
        sensor.ready(LONG).await.unwrap();
        for number in 0..2 {
            sends.send(&bytes(&number.to_string())).await.unwrap();
        }
        let mut newest = None;
        while newest.as_deref() != Some(&b"1"[..]) {
            newest = receives.latest().unwrap().or(newest);
            tokio::task::yield_now().await;
        }
    });
}

#[test]
fn a_full_queue_stops_a_call_that_does_not_wait() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options).await;
        let mut sends = sensor.publisher("measurements").unwrap();
        let mut receives = controller.subscriber("sensor").unwrap();
        sensor.ready(LONG).await.unwrap();
        let mut accepted = 0_u64;
        let full = loop {
            match sends.try_send(&bytes(&accepted.to_string())) {
                Ok(()) => accepted += 1,
                Err(error) => break error,
            }
        };
        assert!(matches!(full, TrySendError::Full { .. }), "{full:?}");
        for number in 0..accepted {
            assert_eq!(receives.recv().await.unwrap(), number.to_string(), "`wait` loses nothing");
        }
    });
}

#[test]
fn work_is_pushed_and_pulled() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options).await;
        let mut pushes = sensor.pusher("work").unwrap();
        let mut pulls = controller.puller("work").unwrap();
        pushes.send(&bytes("1")).await.unwrap();
        pushes.try_send(&bytes("2")).unwrap();
        assert_eq!(pulls.recv().await.unwrap(), "1");
        assert_eq!(pulls.recv().await.unwrap(), "2");
        assert!(pushes.is_connected() && pulls.is_connected());
        assert_eq!((pushes.stats().sent, pulls.stats().received, pushes.peer_stats().len()), (2, 2, 1));
        assert_eq!((pulls.try_recv().unwrap(), pulls.latest().unwrap()), (None, None));
    });
}

#[test]
fn requests_are_answered() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options).await;
        let mut asks = controller.requester("calibrate").unwrap();
        let mut answers = sensor.replier("calibrate").unwrap();
        assert!(answers.try_recv().unwrap().is_none());
        for _ in 0..2 {
            let question = bytes("7");
            let answering = async {
                let request = answers.recv().await.unwrap();
                assert_eq!((request.message(), request.len()), (&bytes("7"), 1));
                request.reply(&bytes("\"done\"")).unwrap();
            };
            let (answer, ()) = tokio::join!(asks.call(&question), answering);
            assert_eq!(answer.unwrap(), "\"done\"");
        }
        assert_eq!(asks.timeout(), LONG);
        assert!(asks.is_connected() && answers.is_connected());
        assert_eq!((asks.stats().sent, asks.stats().received, answers.stats().received), (2, 2, 2));
    });
}

/// Closing waits for the messages of gates that were taken, and the component is open as long as one of them exists.
#[test]
fn a_taken_gate_keeps_its_component_open() {
    on_each_transport_async(|options| async {
        let (mut sensor, mut controller) = open(options.clone()).await;
        let mut pushes = sensor.pusher("work").unwrap();
        let mut pulls = controller.puller("work").unwrap();
        for number in 0..3 {
            pushes.send(&bytes(&number.to_string())).await.unwrap();
        }
        let (closed, ()) = tokio::join!(sensor.close(LONG), async {
            for number in 0..3 {
                assert_eq!(pulls.recv().await.unwrap(), number.to_string());
            }
        });
        closed.unwrap();
        pushes.send(&bytes("later")).await.unwrap();
        assert_eq!(pulls.recv().await.unwrap(), "later");
        drop(pushes);
        // The last gate is gone, so another may open it.
        Component::open_with(&plan("sensor"), options).await.unwrap().close(LONG).await.unwrap();
    });
}

#[test]
fn closing_names_who_did_not_take_everything() {
    on_each_transport_async(|options| async {
        let (mut sensor, controller) = open(options).await;
        let mut sends = sensor.publisher("measurements").unwrap();
        sensor.ready(LONG).await.unwrap();
        while sends.try_send(&bytes("[]")).is_ok() {}
        let error = sensor.close(Duration::from_millis(1)).await.unwrap_err();
        assert_eq!((error.peers.len(), error.is_failure()), (1, true), "{error}");
        assert!(error.to_string().contains("from `sensor.measurements` to `controller.sensor`"), "{error}");
        drop(controller);
    });
}

#[test]
fn gates_are_taken_without_a_kind() {
    on_each_transport_async(|options| async {
        let (mut sensor, controller) = open(options).await;
        sensor.ready(LONG).await.unwrap();
        controller.ready(LONG).await.unwrap();
        let names: Vec<&str> = sensor.spec().gates.iter().map(|gate| gate.name).collect();
        for name in names {
            let gate = sensor.gate(name).unwrap();
            assert_eq!(gate.spec().name, name);
            assert_eq!(gate.stats().received, 0);
            let _ = gate.is_connected();
        }
        sensor.ready(LONG).await.unwrap();
    });
}
