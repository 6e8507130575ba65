//! Requesting and replying ends, moved on together.

use super::stage::{Stage, endpoint};
use crate::transport::{Answer, IncomingRequest, Replier, Requester, Transport};
use bytes::Bytes;
use std::future::poll_fn;
use std::task::{Context, Poll};

impl Stage {
    pub(super) fn requester(&self) -> Box<dyn Requester> {
        self.transport.request(&endpoint()).unwrap()
    }

    pub(super) fn replier(&self) -> Box<dyn Replier> {
        self.transport.reply(&endpoint()).unwrap()
    }
}

pub(super) async fn connected(requester: &mut dyn Requester, replier: &mut dyn Replier) {
    poll_fn(|cx| {
        assert!(replier.poll_request(cx).is_pending(), "received a request that was not sent");
        requester.poll_connected(cx)
    })
    .await;
}

pub(super) async fn ask(requester: &mut dyn Requester, id: u64, body: Bytes) {
    poll_fn(|cx| {
        assert_eq!(requester.request(cx, id, body.clone()), Ok(()));
        Poll::Ready(())
    })
    .await;
}

pub(super) async fn request(requester: &mut dyn Requester, replier: &mut dyn Replier) -> IncomingRequest {
    poll_fn(|cx| {
        // A long request is not written at once.
        assert!(requester.poll_answer(cx).is_pending(), "received a reply that was not sent");
        replier.poll_request(cx)
    })
    .await
}

/// Replies to every request with its body reversed.
pub(super) fn echo(replier: &mut dyn Replier, cx: &mut Context<'_>) {
    while let Poll::Ready(IncomingRequest { body, envelope, path }) = replier.poll_request(cx) {
        let _gone_requesters_do_not_matter = path.reply(&envelope, body.iter().rev().copied().collect());
    }
}

pub(super) async fn answer(requester: &mut dyn Requester, replier: &mut dyn Replier) -> Option<(u64, Bytes)> {
    poll_fn(|cx| {
        replier.drive(cx);
        requester.poll_answer(cx).map(|answer| match answer {
            Answer::Reply { id, body } => Some((id, body)),
            Answer::Refused { .. } | Answer::Lost => None,
        })
    })
    .await
}
