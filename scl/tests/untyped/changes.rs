//! Whether peers are connected is noticed at once, also if a call of the program found it out and not a background
//! task.

use super::{LONG, bytes, on_each_transport, on_each_transport_async, plan};
use scl::untyped::Component;
use std::future::poll_fn;
use std::pin::pin;
use std::sync::mpsc;
use std::task::Poll;
use std::thread;
use std::time::Duration;
use tokio::time::timeout;

/// With a time limit, this would end by it and succeed.
const FOREVER: Duration = Duration::MAX;

#[test]
fn a_component_is_ready_when_its_waiting_call_has_connected() {
    on_each_transport_async(|options| async move {
        let mut logger = Component::open_with(&plan("logger"), options.clone()).await.unwrap();
        let mut raw = logger.subscriber("raw").unwrap();
        let mut received = pin!(raw.recv());
        assert!(poll_fn(|cx| Poll::Ready(received.as_mut().poll(cx).is_pending())).await);
        // A task of its own, which only a report wakes.
        let ready = tokio::spawn(async move { logger.ready(FOREVER).await });
        tokio::task::yield_now().await;
        // Both wait, and the peer comes.
        let _sensor = Component::open_with(&plan("sensor"), options).await.unwrap();
        let became_ready = async { ready.await.unwrap() };
        tokio::select! {
            biased;
            _ = received => panic!("nobody sends"),
            ready = timeout(LONG, became_ready) => ready.expect("the gate is connected").unwrap(),
        }
    });
}

#[test]
fn a_component_without_async_is_ready_while_all_its_gates_wait_in_threads() {
    on_each_transport(|options| {
        let mut controller = Component::open_blocking_with(&plan("controller"), options.clone()).unwrap();
        let (mut sub, mut raw) = (controller.subscriber("sensor").unwrap(), controller.subscriber("raw").unwrap());
        let (mut req, mut pull) = (controller.requester("calibrate").unwrap(), controller.puller("work").unwrap());
        let closer = controller.closer();
        let (became_ready, is_ready) = mpsc::channel();
        thread::scope(|threads| {
            threads.spawn(move || assert!(sub.recv_blocking().is_err()));
            threads.spawn(move || assert!(raw.recv_timeout(FOREVER).is_err()));
            threads.spawn(move || assert!(pull.recv_blocking().is_err()));
            threads.spawn(move || assert!(req.call_timeout(&bytes("7"), LONG).is_err()));
            threads.spawn(|| became_ready.send(controller.ready_blocking(FOREVER).is_ok()));
            let _sensor = Component::open_blocking_with(&plan("sensor"), options).unwrap();
            let told = is_ready.recv_timeout(LONG);
            closer.end_calls();
            assert_eq!(told, Ok(true));
        });
    });
}

#[test]
fn a_peer_that_a_sending_call_has_found_gone_is_reported() {
    on_each_transport_async(|options| async move {
        let mut sensor = Component::open_with(&plan("sensor"), options.clone()).await.unwrap();
        let controller = Component::open_with(&plan("controller"), options).await.unwrap();
        let mut raw = sensor.publisher("raw").unwrap();
        controller.ready(LONG).await.unwrap();
        while raw.stats().peers == 0 {
            tokio::task::yield_now().await;
        }
        assert_eq!(raw.peers_changed().await, 1);
        // Nothing is awaited from here on, so no task takes anything.
        while raw.stats().dropped_oldest == 0 {
            raw.try_send(&bytes("1")).unwrap();
        }
        drop(controller);
        // In memory, the first call notices; sockets report it to the runtime first.
        raw.try_send(&bytes("2")).unwrap();
        while raw.stats().peers > 0 {
            tokio::task::yield_now().await;
            raw.try_send(&bytes("2")).unwrap();
        }
        let peers = timeout(LONG, raw.peers_changed()).await;
        assert_eq!(peers.expect("that is a change"), 0);
    });
}
