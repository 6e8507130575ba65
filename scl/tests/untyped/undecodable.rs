//! Messages that a typed gate cannot decode, sent by an untyped one.

use super::{LONG, bytes, on_each_transport, on_each_transport_async, system_plan};
use futures_core::Stream;
use scl::plan::Plan;
use scl::untyped::Component;
use scl::{CallError, OpenOptions, RecvError, RecvTimeoutError};
use std::future::poll_fn;
use std::pin::Pin;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

scl::topology!("../undecodable.yaml");

type Values = Vec<f64>;

pub(super) fn plan(component: &str) -> Plan {
    system_plan("undecodable.yaml").component(component).unwrap().clone()
}

async fn open(options: OpenOptions) -> (Component, Sink) {
    let source = Component::open_with(&plan("source"), options.clone()).await.unwrap();
    let sink = Sink::open_with(options).await.unwrap();
    source.ready(LONG).await.unwrap();
    sink.ready(LONG).await.unwrap();
    (source, sink)
}

#[test]
fn an_undecodable_message_is_counted_and_skipped() {
    on_each_transport_async(|options| async {
        let (mut source, mut sink) = open(options).await;
        let (mut values, mut jobs) = (source.publisher("values").unwrap(), source.pusher("jobs").unwrap());
        // More than are skipped at once.
        for _ in 0..200 {
            values.send(&bytes("no JSON")).await.unwrap();
        }
        values.send(&bytes("[1.5]")).await.unwrap();
        assert_eq!(sink.values.recv().await.unwrap(), [1.5]);
        values.send(&bytes("no JSON")).await.unwrap();
        values.send(&bytes("[2.5]")).await.unwrap();
        let next = poll_fn(|cx| Pin::new(&mut sink.values).poll_next(cx)).await;
        assert_eq!(next.unwrap().unwrap(), [2.5], "a stream");
        let stats = sink.values.stats();
        assert_eq!((stats.received, stats.rejected, stats.undecodable), (203, 201, 201));

        jobs.send(&bytes("{}")).await.unwrap();
        jobs.send(&bytes("[3.5]")).await.unwrap();
        assert_eq!(sink.jobs.recv().await.unwrap(), [3.5]);
        assert_eq!(sink.jobs.stats().undecodable, 1);
    });
}

#[test]
fn a_call_that_does_not_wait_skips_too() {
    on_each_transport_async(|options| async {
        let (mut source, mut sink) = open(options).await;
        let mut values = source.publisher("values").unwrap();
        for text in ["[1]", "[2]", "no JSON", "nor this"] {
            values.send(&bytes(text)).await.unwrap();
        }
        while sink.values.stats().received < 4 {
            tokio::task::yield_now().await;
        }
        assert_eq!(sink.values.latest().unwrap(), Some(vec![2.0]), "the newest that can be decoded");
        assert_eq!(sink.values.latest().unwrap(), None);
        assert_eq!(sink.values.stats().undecodable, 2);
        values.send(&bytes("no JSON")).await.unwrap();
        values.send(&bytes("[3]")).await.unwrap();
        while sink.values.stats().received < 6 {
            tokio::task::yield_now().await;
        }
        assert_eq!(sink.values.try_recv().unwrap(), Some(vec![3.0]));
        assert_eq!(sink.values.try_recv().unwrap(), None);
    });
}

#[test]
fn a_gate_that_declares_it_fails() {
    on_each_transport_async(|options| async {
        let (mut source, mut sink) = open(options).await;
        let mut strict = source.publisher("strict").unwrap();
        strict.send(&bytes("no JSON")).await.unwrap();
        strict.send(&bytes("[1.5]")).await.unwrap();
        let error = sink.strict.recv().await.unwrap_err();
        assert!(matches!(error, RecvError::Decode { .. }), "{error}");
        assert_eq!(sink.strict.recv().await.unwrap(), [1.5]);
        assert_eq!(sink.strict.stats().undecodable, 1);
    });
}

#[test]
fn a_stream_of_undecodable_messages_keeps_no_call_beyond_its_time() {
    on_each_transport(|options| {
        let mut source = Component::open_blocking_with(&plan("source"), options.clone()).unwrap();
        let mut sink = Sink::open_blocking_with(options).unwrap();
        source.ready_blocking(LONG).unwrap();
        sink.ready_blocking(LONG).unwrap();
        let mut values = source.publisher("values").unwrap();
        let done = AtomicBool::new(false);
        std::thread::scope(|scope| {
            scope.spawn(|| {
                while !done.load(Ordering::Relaxed) {
                    values.send_blocking(&bytes("no JSON")).unwrap();
                }
            });
            while sink.values.stats().received == 0 {
                std::thread::yield_now();
            }
            let error = sink.values.recv_timeout(Duration::from_millis(20)).unwrap_err();
            done.store(true, Ordering::Relaxed);
            assert!(matches!(error, RecvTimeoutError::Timeout { .. }), "{error}");
        });
    });
}

#[test]
fn a_stream_of_undecodable_messages_leaves_other_tasks_their_turn() {
    on_each_transport_async(|options| async {
        let (mut source, mut sink) = open(options).await;
        let mut values = source.publisher("values").unwrap();
        for _ in 0..500 {
            values.send(&bytes("no JSON")).await.unwrap();
        }
        while sink.values.stats().received < 500 {
            tokio::task::yield_now().await;
        }
        let mut polls = 0;
        tokio::select! {
            biased;
            received = sink.values.recv() => panic!("{received:?}"),
            () = poll_fn(|_| { polls += 1; std::task::Poll::Ready(()) }) => {}
        }
        assert_eq!(polls, 1);
        let skipped = sink.values.stats().undecodable;
        assert!((1..500).contains(&skipped), "{skipped} at once");
        values.send(&bytes("[1.5]")).await.unwrap();
        assert_eq!(sink.values.recv().await.unwrap(), [1.5], "after a call that was dropped");
    });
}

#[test]
fn the_sender_of_an_undecodable_request_is_told() {
    on_each_transport_async(|options| async {
        let (mut source, mut sink) = open(options).await;
        let mut ask = source.requester("ask").unwrap();
        let (none, some) = (bytes("no JSON"), bytes("42"));
        let (error, ()) = tokio::join!(
            async {
                let error = ask.call(&none).await.unwrap_err();
                assert_eq!(ask.call(&some).await.unwrap(), "\"done\"");
                error
            },
            async {
                let request = sink.ask.recv().await.unwrap();
                assert_eq!(*request, 42);
                request.reply(&"done".to_owned()).unwrap();
            }
        );
        assert!(matches!(error, CallError::Refused { .. }), "{error}");
        assert_eq!(error.to_string(), "gate `source.ask` got no reply: `sink.ask` could not decode the request");
        let stats = sink.ask.stats();
        assert_eq!((stats.received, stats.rejected, stats.undecodable), (2, 1, 1));
    });
}
