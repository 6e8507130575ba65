//! Calls that are in progress at the same time, at a gate with `in_flight: 8`.

use super::undecodable::plan;
use super::{LONG, bytes, on_each_transport_async};
use bytes::Bytes;
use scl::untyped::Component;
use scl::{CallError, OpenOptions, Rep, Req};
use std::future::poll_fn;
use std::task::Poll;
use std::time::Duration;
use tokio::task::JoinHandle;

const LIMIT: usize = 8;

struct System {
    requester: Req<Bytes, Bytes>,
    replier: Rep<Bytes, Bytes>,
    _source: Component,
    _sink: Component,
}

async fn open(options: OpenOptions) -> System {
    let mut source = Component::open_with(&plan("source"), options.clone()).await.unwrap();
    let mut sink = Component::open_with(&plan("sink"), options).await.unwrap();
    source.ready(LONG).await.unwrap();
    sink.ready(LONG).await.unwrap();
    let (requester, replier) = (source.requester("ask").unwrap(), sink.replier("ask").unwrap());
    System { requester, replier, _source: source, _sink: sink }
}

fn call(requester: &Req<Bytes, Bytes>, request: Bytes) -> JoinHandle<Result<Bytes, CallError>> {
    let mut requester = requester.clone();
    tokio::spawn(async move { requester.call(&request).await })
}

/// What has become of all calls.
async fn results(calls: Vec<JoinHandle<Result<Bytes, CallError>>>) -> Vec<Result<Bytes, CallError>> {
    let mut results = Vec::new();
    for call in calls {
        results.push(call.await.unwrap());
    }
    results
}

#[test]
fn each_call_gets_its_own_reply_in_whatever_order_they_come() {
    on_each_transport_async(|options| async {
        let mut system = open(options).await;
        let numbers = || 0..2 * LIMIT;
        let calls: Vec<_> = numbers().map(|number| call(&system.requester, bytes(&number.to_string()))).collect();
        let mut requests = Vec::new();
        for _ in 0..LIMIT {
            requests.push(system.replier.recv().await.unwrap());
        }
        assert!(system.replier.try_recv().unwrap().is_none(), "more requests than may be in flight");
        assert_eq!(system.requester.stats().sent, LIMIT as u64);
        // Backwards, and each reply lets another call begin.
        while let Some(request) = requests.pop() {
            let reply = bytes(&format!("reply to {}", request.message().escape_ascii()));
            request.reply(&reply).unwrap();
            if system.requester.stats().sent < 2 * LIMIT as u64 {
                requests.insert(0, system.replier.recv().await.unwrap());
            }
        }
        for (number, reply) in numbers().zip(results(calls).await) {
            assert_eq!(reply.unwrap(), format!("reply to {number}"));
        }
    });
}

#[test]
fn a_call_beyond_the_limit_waits_within_its_timeout() {
    on_each_transport_async(|options| async {
        let mut system = open(options).await;
        let calls: Vec<_> = (0..LIMIT).map(|_| call(&system.requester, bytes("question"))).collect();
        let mut requests = Vec::new();
        for _ in 0..LIMIT {
            requests.push(system.replier.recv().await.unwrap());
        }
        let impatient = system.requester.call_within(&bytes("never sent"), Duration::from_millis(10)).await;
        assert!(matches!(impatient, Err(CallError::Timeout { .. })), "{impatient:?}");
        requests.into_iter().for_each(|request| request.reply(&bytes("reply")).unwrap());
        assert!(results(calls).await.into_iter().all(|reply| reply.unwrap() == "reply"));
        assert!(system.replier.try_recv().unwrap().is_none(), "a call that timed out was sent");
    });
}

#[test]
fn a_late_reply_belongs_to_no_other_call() {
    on_each_transport_async(|options| async {
        let mut system = open(options).await;
        let dropped = call(&system.requester, bytes("first"));
        let late = system.replier.recv().await.unwrap();
        dropped.abort();
        assert!(dropped.await.unwrap_err().is_cancelled());
        let calls: Vec<_> = (0..LIMIT).map(|_| call(&system.requester, bytes("question"))).collect();
        let mut requests = vec![late];
        for _ in 0..LIMIT {
            requests.push(system.replier.recv().await.unwrap());
        }
        for (number, request) in requests.into_iter().enumerate() {
            request.reply(&bytes(if number == 0 { "late" } else { "reply" })).unwrap();
        }
        assert!(results(calls).await.into_iter().all(|reply| reply.unwrap() == "reply"));
    });
}

#[test]
fn a_peer_that_is_lost_fails_all_calls_in_progress() {
    on_each_transport_async(|options| async {
        let System { requester, mut replier, _source, _sink } = open(options.clone()).await;
        let calls: Vec<_> = (0..LIMIT).map(|_| call(&requester, bytes("question"))).collect();
        for _ in 0..LIMIT {
            let _unanswered = replier.recv().await.unwrap();
        }
        drop((replier, _sink));
        for lost in results(calls).await {
            assert!(matches!(lost, Err(CallError::PeerLost { .. })), "{lost:?}");
        }
        let mut sink = Component::open_with(&plan("sink"), options).await.unwrap();
        let mut replier = sink.replier("ask").unwrap();
        let next = call(&requester, bytes("question"));
        replier.recv().await.unwrap().reply(&bytes("reply")).unwrap();
        assert_eq!(next.await.unwrap().unwrap(), "reply");
    });
}

#[test]
fn long_requests_and_replies_are_in_flight_at_once() {
    on_each_transport_async(|options| async {
        let mut system = open(options).await;
        let long = Bytes::from(vec![7; 2 << 20]);
        let calls: Vec<_> = (0..LIMIT).map(|_| call(&system.requester, long.clone())).collect();
        let mut requests = Vec::new();
        for _ in 0..LIMIT {
            requests.push(system.replier.recv().await.unwrap());
        }
        requests.into_iter().for_each(|request| request.reply(&long).unwrap());
        assert!(results(calls).await.into_iter().all(|reply| reply.unwrap() == long));
    });
}

/// The task that is polled last is not the only one that reads replies.
#[test]
fn no_call_depends_on_another_one_being_polled() {
    on_each_transport_async(|options| async {
        let mut system = open(options).await;
        let (mut first, question) = (system.requester.clone(), bytes("question"));
        let mut abandoned = Box::pin(first.call(&question));
        let other = call(&system.requester, bytes("other"));
        while system.requester.stats().sent < 2 {
            assert!(poll_fn(|cx| Poll::Ready(abandoned.as_mut().poll(cx).is_pending())).await);
            tokio::task::yield_now().await;
        }
        assert!(poll_fn(|cx| Poll::Ready(abandoned.as_mut().poll(cx).is_pending())).await);
        for _ in 0..2 {
            system.replier.recv().await.unwrap().reply(&bytes("reply")).unwrap();
        }
        assert_eq!(other.await.unwrap().unwrap(), "reply");
        assert_eq!(abandoned.await.unwrap(), "reply");
    });
}
