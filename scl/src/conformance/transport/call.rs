//! What asking and answering ends guarantee.

use super::watched::{Answering, Asking};
use super::{ENDPOINT, SIZES, opened, pattern};
use crate::transport::{Answer, Asked, RequesterGone, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::task::Poll;

/// A reply goes to who asked, under the number of its request, in whatever order the replies are given.
pub async fn answers_who_asked_in_any_order(transport: &dyn Transport) {
    let mut answerer = answering(transport, ENDPOINT);
    let mut askers = [asking(transport, ENDPOINT), asking(transport, ENDPOINT), asking(transport, ENDPOINT)];
    for asker in &mut askers {
        connected(asker, &mut answerer).await;
    }
    for (asker, name) in askers.iter_mut().zip(b'a'..) {
        for id in 0..4 {
            assert_eq!(asker.ask(id, text(name, id)), Ok(()), "the replier is there and was asked in vain");
        }
    }
    let mut asked = Vec::new();
    for _ in 0..12 {
        asked.push(next_request(&mut answerer).await);
    }
    for Asked { body, responder } in asked.into_iter().rev() {
        let reply = [b"to ", &body[..]].concat();
        assert_eq!(responder.respond(reply.into()), Ok(()), "the requester is there and could not be answered");
    }
    for (asker, name) in askers.iter_mut().zip(b'a'..) {
        for id in (0..4).rev() {
            let expected = [b"to ", &text(name, id)[..]].concat();
            assert_eq!(next_reply(asker, &mut answerer).await, (id, expected.into()));
        }
    }
}

/// The answer to an earlier request keeps its number, so it is never taken for the answer to a later one.
pub async fn numbers_old_answers(transport: &dyn Transport) {
    let (mut asker, mut answerer) = pair(transport, ENDPOINT).await;
    let ids = [7, u64::MAX, 0];
    let mut requests = Vec::new();
    for id in ids {
        assert_eq!(asker.ask(id, text(b'q', id)), Ok(()));
        requests.push(next_request(&mut answerer).await);
    }
    for request in requests {
        let body = request.body.clone();
        assert_eq!(request.responder.respond(body), Ok(()));
    }
    for id in ids {
        assert_eq!(next_reply(&mut asker, &mut answerer).await, (id, text(b'q', id)));
    }
}

/// Requests and replies of 0 bytes, of 1 byte, and up to 1 MiB arrive as they were sent.
pub async fn carries_requests_of_every_size(transport: &dyn Transport) {
    let (mut asker, mut answerer) = pair(transport, ENDPOINT).await;
    for (id, size) in (1..).zip(SIZES) {
        assert_eq!(asker.ask(id, pattern(size)), Ok(()));
        let request = next_request(&mut answerer).await;
        assert!(request.body == pattern(size), "a request of {size} bytes is damaged");
        assert_eq!(request.responder.respond(request.body), Ok(()));
        let reply = next_reply(&mut asker, &mut answerer).await;
        assert!(reply == (id, pattern(size)), "a reply of {size} bytes is damaged");
    }
}

/// A request while no replier is there is given back, and is not delivered later.
pub async fn gives_back_what_nobody_answers(transport: &dyn Transport) {
    let mut asker = asking(transport, ENDPOINT);
    let body = Bytes::from_static(b"anybody?");
    assert_eq!(asker.ask(1, body.clone()), Err(body), "nobody is there and was asked");
    assert!(!asker.is_connected());
    let mut answerer = answering(transport, ENDPOINT);
    connected(&mut asker, &mut answerer).await;
    assert!(asker.is_connected());
    check_one(&mut asker, &mut answerer, 2).await;
}

/// A requester is told that the replier went away, and can ask the next one at the same endpoint.
pub async fn tells_of_a_lost_replier(transport: &dyn Transport) {
    let mut asker = asking(transport, ENDPOINT);
    for id in 0..5 {
        let mut answerer = answering(transport, ENDPOINT);
        connected(&mut asker, &mut answerer).await;
        check_one(&mut asker, &mut answerer, id).await;
        assert_eq!(asker.ask(100 + id, Bytes::from_static(b"answer this")), Ok(()));
        let unanswered = next_request(&mut answerer).await;
        drop(answerer);
        match poll_fn(|cx| asker.poll_answer(cx)).await {
            Answer::Lost => assert!(!asker.is_connected(), "lost and connected"),
            Answer::Reply { id, .. } => panic!("request {id} was answered by nobody"),
        }
        let late = unanswered.responder.respond(Bytes::from_static(b"too late"));
        assert_eq!(late, Err(RequesterGone), "an answer was taken by an end that is gone");
    }
}

/// A requester finds the replier that stays, whatever it was doing with one that went away at once.
pub async fn finds_the_replier_that_stays(transport: &dyn Transport) {
    let mut asker = asking(transport, ENDPOINT);
    for turns in 0..60 {
        let mut hasty = answering(transport, ENDPOINT);
        for _ in 0..turns {
            poll_fn(|cx| {
                let _ = (hasty.poll(cx), asker.poll_connected(cx));
                Poll::Ready(())
            })
            .await;
            tokio::task::yield_now().await;
        }
        drop(hasty);
        let mut answerer = answering(transport, ENDPOINT);
        while !is_answered(&mut asker, &mut answerer).await {}
    }
}

/// Asks once; false if the replier was one that is gone.
async fn is_answered(asker: &mut Asking, answerer: &mut Answering) -> bool {
    let mut asked = false;
    let answer = poll_fn(|cx| {
        if !asked && asker.poll_connected(cx).is_ready() {
            asked = asker.ask(1, Bytes::from_static(b"there?")).is_ok();
            if !asked {
                // The connection broke at this very moment.
                cx.waker().wake_by_ref();
            }
        }
        while let Poll::Ready(request) = answerer.poll(cx) {
            // A requester that gave up is none of this replier's business.
            let _ = request.responder.respond(request.body);
        }
        if asked { asker.poll_answer(cx) } else { Poll::Pending }
    })
    .await;
    matches!(answer, Answer::Reply { .. })
}

/// A requester that goes away disturbs neither the replier nor the other requesters, also when it is answered.
pub async fn survives_a_lost_requester(transport: &dyn Transport) {
    let (mut asker, mut answerer) = pair(transport, ENDPOINT).await;
    for id in 0..5 {
        let mut other = asking(transport, ENDPOINT);
        connected(&mut other, &mut answerer).await;
        assert_eq!(other.ask(id, Bytes::from_static(b"and away")), Ok(()));
        let request = next_request(&mut answerer).await;
        drop(other);
        // Whether it is known by now that nobody waits does not matter here.
        let _ = request.responder.respond(Bytes::from_static(b"to nobody"));
        check_one(&mut asker, &mut answerer, id).await;
    }
}

/// A connected pair.
pub(super) async fn pair(transport: &dyn Transport, endpoint: &str) -> (Asking, Answering) {
    let mut asker = asking(transport, endpoint);
    let mut answerer = answering(transport, endpoint);
    connected(&mut asker, &mut answerer).await;
    (asker, answerer)
}

fn asking(transport: &dyn Transport, endpoint: &str) -> Asking {
    Asking::new(opened(transport.request(endpoint)))
}

fn answering(transport: &dyn Transport, endpoint: &str) -> Answering {
    Answering::new(opened(transport.reply(endpoint)))
}

async fn connected(asker: &mut Asking, answerer: &mut Answering) {
    poll_fn(|cx| {
        assert!(answerer.poll(cx).is_pending(), "asked what nobody asked");
        asker.poll_connected(cx)
    })
    .await;
}

async fn check_one(asker: &mut Asking, answerer: &mut Answering, id: u64) {
    assert_eq!(asker.ask(id, text(b'c', id)), Ok(()), "the replier is there and was asked in vain");
    let request = next_request(answerer).await;
    assert_eq!(request.body, text(b'c', id));
    assert_eq!(request.responder.respond(text(b'r', id)), Ok(()), "the requester is there");
    assert_eq!(next_reply(asker, answerer).await, (id, text(b'r', id)));
}

async fn next_request(answerer: &mut Answering) -> Asked {
    poll_fn(|cx| answerer.poll(cx)).await
}

async fn next_reply(asker: &mut Asking, answerer: &mut Answering) -> (u64, Bytes) {
    let answer = poll_fn(|cx| match answerer.poll(cx) {
        Poll::Ready(asked) => panic!("asked what nobody asked: {:?}", asked.body),
        Poll::Pending => asker.poll_answer(cx),
    });
    match answer.await {
        Answer::Reply { id, body } => (id, body),
        Answer::Lost => panic!("the replier is there, but is reported as lost"),
    }
}

fn text(name: u8, id: u64) -> Bytes {
    format!("{}{id}", char::from(name)).into()
}
