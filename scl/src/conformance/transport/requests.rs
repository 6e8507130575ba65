//! Requests and replies.

use super::request_ends::{TestReplier, TestRequester};
use super::{ENDPOINT, SIZES, content, opened};
use crate::transport::{Answer, Endpoint, IncomingRequest, RequesterGone, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;

/// Each reply reaches its requester under the number of its request; replies may be sent in any order.
pub async fn answers_in_any_order(transport: &dyn Transport) {
    let endpoint = Endpoint::new(ENDPOINT);
    let mut replier = replier(transport, &endpoint);
    let mut requesters = [(); 3].map(|()| requester(transport, &endpoint));
    for requester in &mut requesters {
        connect(requester, &mut replier).await;
    }
    for (requester, name) in requesters.iter_mut().zip(b'a'..) {
        for id in 0..4 {
            assert_eq!(requester.request(id, text(name, id)), Ok(()), "the replier is connected");
        }
    }
    let mut requests = Vec::new();
    for _ in 0..12 {
        let request = poll_fn(|cx| {
            for requester in &mut requesters {
                assert!(requester.poll_answer(cx).is_pending(), "received an answer before any request was answered");
            }
            replier.poll(cx)
        });
        requests.push(request.await);
    }
    for request in requests.into_iter().rev() {
        let body = [b"to ", &request.body[..]].concat().into();
        assert_eq!(reply(&request, body), Ok(()), "the requester is connected");
    }
    for (requester, name) in requesters.iter_mut().zip(b'a'..) {
        for id in (0..4).rev() {
            let expected = [b"to ", &text(name, id)[..]].concat();
            assert_eq!(next_reply(requester, &mut replier).await, (id, expected.into()));
        }
    }
}

/// The reply to an earlier request keeps its number, so it is never taken for the reply to a later one.
pub async fn keeps_request_numbers(transport: &dyn Transport) {
    let (mut requester, mut replier) = pair(transport).await;
    let ids = [7, u64::MAX, 0];
    let mut requests = Vec::new();
    for id in ids {
        assert_eq!(requester.request(id, text(b'q', id)), Ok(()), "the replier is connected");
        requests.push(next_request(&mut requester, &mut replier).await);
    }
    for request in requests {
        assert_eq!(reply(&request, request.body.clone()), Ok(()), "the requester is connected");
    }
    for id in ids {
        assert_eq!(next_reply(&mut requester, &mut replier).await, (id, text(b'q', id)));
    }
}

/// Requests and replies of 0 bytes, of 1 byte, and of up to 1 MiB arrive unchanged.
pub async fn carries_requests_of_every_size(transport: &dyn Transport) {
    let (mut requester, mut replier) = pair(transport).await;
    for (id, size) in (1..).zip(SIZES) {
        assert_eq!(requester.request(id, content(size)), Ok(()), "the replier is connected");
        let request = next_request(&mut requester, &mut replier).await;
        assert!(request.body == content(size), "a request of {size} bytes is damaged");
        assert_eq!(reply(&request, request.body.clone()), Ok(()), "the requester is connected");
        let reply = next_reply(&mut requester, &mut replier).await;
        assert!(reply == (id, content(size)), "a reply of {size} bytes is damaged");
    }
}

/// A request or reply longer than the limit of its receiver is never received. The requester learns that the connection
/// broke, and a shorter request is answered over the next one.
pub async fn never_delivers_an_oversized_request(transport: &dyn Transport) {
    const LIMIT: usize = 1000;
    let endpoint = Endpoint { max_size: LIMIT, ..Endpoint::new(ENDPOINT) };
    let mut replier = replier(transport, &endpoint);
    let mut requester = requester(transport, &endpoint);
    for size in [LIMIT + 1, 70_000] {
        connect(&mut requester, &mut replier).await;
        assert_eq!(requester.request(1, content(size)), Ok(()), "the replier is connected");
        let lost = poll_fn(|cx| {
            assert!(replier.poll(cx).is_pending(), "received a request of {size} bytes");
            requester.poll_answer(cx)
        });
        assert!(matches!(lost.await, Answer::Lost), "a request of {size} bytes was answered");

        connect(&mut requester, &mut replier).await;
        assert_eq!(requester.request(2, content(LIMIT)), Ok(()), "the replier is connected");
        let request = next_request(&mut requester, &mut replier).await;
        assert_eq!(request.body, content(LIMIT));
        assert_eq!(reply(&request, content(size)), Ok(()), "the requester is connected");
        let lost = poll_fn(|cx| {
            assert!(replier.poll(cx).is_pending(), "received a request that was not sent");
            requester.poll_answer(cx)
        });
        assert!(matches!(lost.await, Answer::Lost), "received a reply of {size} bytes");
    }
    connect(&mut requester, &mut replier).await;
    check_call(&mut requester, &mut replier, 3).await;
}

/// A request while no replier is connected is returned, and not delivered later.
pub async fn refuses_requests_without_a_replier(transport: &dyn Transport) {
    let mut requester = requester(transport, &Endpoint::new(ENDPOINT));
    let body = Bytes::from_static(b"is anybody there?");
    assert_eq!(requester.request(1, body.clone()), Err(body), "a request was accepted without a replier");
    assert!(!requester.end.is_connected());
    let mut replier = replier(transport, &Endpoint::new(ENDPOINT));
    connect(&mut requester, &mut replier).await;
    assert!(requester.end.is_connected());
    check_call(&mut requester, &mut replier, 2).await;
}

/// A requester learns that the replier was dropped, and is answered by the next one at the same endpoint. A reply to a
/// request of the dropped one fails.
pub async fn reports_a_lost_replier(transport: &dyn Transport) {
    let mut requester = requester(transport, &Endpoint::new(ENDPOINT));
    for id in 0..5 {
        let mut replier = replier(transport, &Endpoint::new(ENDPOINT));
        connect(&mut requester, &mut replier).await;
        check_call(&mut requester, &mut replier, id).await;
        assert_eq!(requester.request(100 + id, Bytes::from_static(b"question")), Ok(()), "the replier is connected");
        let unanswered = next_request(&mut requester, &mut replier).await;
        poll_fn(|cx| {
            assert!(requester.poll_answer(cx).is_pending(), "received a reply that was not sent");
            Poll::Ready(())
        })
        .await;
        drop(replier);
        match poll_fn(|cx| requester.poll_answer(cx)).await {
            Answer::Lost => assert!(!requester.end.is_connected(), "connected to a replier that is lost"),
            Answer::Reply { id, .. } | Answer::Refused { id } => {
                panic!("received an answer to request {id} that was not sent")
            }
        }
        let late = reply(&unanswered, Bytes::from_static(b"too late"));
        assert_eq!(late, Err(RequesterGone), "a reply was accepted after the replier was dropped");
    }
}

/// A requester finds the replier that stays, at whatever stage of its connection an earlier one was dropped.
pub async fn finds_the_replier_that_stays(transport: &dyn Transport) {
    let endpoint = Endpoint::new(ENDPOINT);
    let mut requester = requester(transport, &endpoint);
    for count in 0..60 {
        let mut brief = replier(transport, &endpoint);
        super::turns(count, |cx| drop((brief.poll(cx), requester.poll_connected(cx)))).await;
        drop(brief);
        let mut replier = replier(transport, &endpoint);
        while !is_answered(&mut requester, &mut replier).await {}
    }
}

/// Sends one request. Returns false if it was lost with a replier that was dropped.
async fn is_answered(requester: &mut TestRequester, replier: &mut TestReplier) -> bool {
    let mut requested = false;
    let answer = poll_fn(|cx| {
        if !requested && requester.poll_connected(cx).is_ready() {
            requested = requester.request(1, Bytes::from_static(b"question")).is_ok();
            if !requested {
                // The connection broke after it was reported; try again.
                cx.waker().wake_by_ref();
            }
        }
        while let Poll::Ready(request) = replier.poll(cx) {
            // Requests of connections that are lost by now cannot be answered.
            let _ = reply(&request, request.body.clone());
        }
        if requested { requester.poll_answer(cx) } else { Poll::Pending }
    })
    .await;
    matches!(answer, Answer::Reply { .. })
}

/// A requester that is dropped affects neither the replier nor other requesters, even if it is answered afterwards.
pub async fn survives_a_lost_requester(transport: &dyn Transport) {
    let (mut requester, mut replier) = pair(transport).await;
    for id in 0..5 {
        let mut other = self::requester(transport, &Endpoint::new(ENDPOINT));
        connect(&mut other, &mut replier).await;
        assert_eq!(other.request(id, Bytes::from_static(b"question")), Ok(()), "the replier is connected");
        let request = next_request(&mut other, &mut replier).await;
        drop(other);
        // Whether the replier knows by now that the requester is gone does not matter.
        let _ = reply(&request, Bytes::from_static(b"reply to nobody"));
        check_call(&mut requester, &mut replier, id).await;
    }
}

/// Replies that the replier reports as written arrive, even if the replier is dropped before the requester looks.
pub async fn delivers_written_replies(transport: &dyn Transport) {
    let (mut requester, mut replier) = pair(transport).await;
    let mut requests = Vec::new();
    for id in 0..10 {
        assert_eq!(requester.request(id, text(b'q', id)), Ok(()), "the replier is connected");
        requests.push(next_request(&mut requester, &mut replier).await);
    }
    for (request, id) in requests.iter().zip(0..) {
        assert_eq!(reply(request, text(b'r', id)), Ok(()), "the requester is connected");
    }
    poll_fn(|cx| replier.poll_written(cx)).await;
    drop(replier);
    for expected in 0..10 {
        let answer = poll_fn(|cx| requester.poll_answer(cx)).await;
        assert_eq!(reply_of(answer), (expected, text(b'r', expected)));
    }
}

/// A requester and a replier that are connected.
pub(super) async fn pair(transport: &dyn Transport) -> (TestRequester, TestReplier) {
    let endpoint = Endpoint::new(ENDPOINT);
    let (mut requester, mut replier) = (requester(transport, &endpoint), replier(transport, &endpoint));
    connect(&mut requester, &mut replier).await;
    (requester, replier)
}

pub(super) fn requester(transport: &dyn Transport, endpoint: &Endpoint) -> TestRequester {
    TestRequester::new(opened(transport.request(endpoint)))
}

pub(super) fn replier(transport: &dyn Transport, endpoint: &Endpoint) -> TestReplier {
    TestReplier::new(opened(transport.reply(endpoint)))
}

/// Waits until the requester is connected, polling the replier too.
pub(super) async fn connect(requester: &mut TestRequester, replier: &mut TestReplier) {
    poll_fn(|cx| {
        assert!(replier.poll(cx).is_pending(), "received a request that was not sent");
        requester.poll_connected(cx)
    })
    .await;
}

/// Checks one request and its reply.
pub(super) async fn check_call(requester: &mut TestRequester, replier: &mut TestReplier, id: u64) {
    assert_eq!(requester.request(id, text(b'c', id)), Ok(()), "the replier is connected");
    let request = next_request(requester, replier).await;
    assert_eq!(request.body, text(b'c', id));
    assert_eq!(reply(&request, text(b'r', id)), Ok(()), "the requester is connected");
    assert_eq!(next_reply(requester, replier).await, (id, text(b'r', id)));
}

fn reply(request: &IncomingRequest, body: Bytes) -> Result<(), RequesterGone> {
    request.path.reply(&request.envelope, body)
}

/// Waits for the next request, polling its requester too, which may still be writing.
pub(super) async fn next_request(requester: &mut TestRequester, replier: &mut TestReplier) -> IncomingRequest {
    poll_fn(|cx| {
        assert!(requester.poll_answer(cx).is_pending(), "received an answer before the request was answered");
        replier.poll(cx)
    })
    .await
}

async fn next_reply(requester: &mut TestRequester, replier: &mut TestReplier) -> (u64, Bytes) {
    let answer = poll_fn(|cx| match replier.poll(cx) {
        Poll::Ready(request) => panic!("received a request that was not sent: {:?}", request.body),
        Poll::Pending => requester.poll_answer(cx),
    });
    reply_of(answer.await)
}

/// The number of a request, and the reply to it.
pub(super) fn reply_of(answer: Answer) -> (u64, Bytes) {
    match answer {
        Answer::Reply { id, body } => (id, body),
        Answer::Refused { .. } | Answer::Lost => panic!("the reply is lost"),
    }
}

pub(super) fn text(name: u8, id: u64) -> Bytes {
    format!("{}{id}", char::from(name)).into()
}
