//! The ends for requests and replies.

use super::IN_FLIGHT;
use super::pipe::{PipeReader, PipeWriter, pipe};
use super::switchboard::{Connector, Listener};
use crate::transport::round_robin::RoundRobin;
use crate::transport::{Answer, Endpoint, IncomingRequest, Replier, ReplyPath, Requester, RequesterGone};
use bytes::{BufMut, Bytes, BytesMut};
use std::sync::Arc;
use std::task::{Context, Poll, Waker, ready};

/// A request and its number.
struct Numbered {
    id: u64,
    body: Bytes,
}

fn fits(answer: &Answer, max_size: usize) -> bool {
    !matches!(answer, Answer::Reply { body, .. } if body.len() > max_size)
}

/// The replier's half of a connection.
pub(super) struct ToRequester {
    requests: PipeReader<Numbered>,
    replies: Arc<PipeWriter<Answer>>,
    envelopes: BytesMut,
}

/// The requester's half of a connection.
pub(super) struct ToReplier {
    requests: PipeWriter<Numbered>,
    replies: PipeReader<Answer>,
}

/// Creates both halves of a connection. The number of replies is not limited: each belongs to a request, and requesters
/// discard old ones before the next request.
pub(super) fn connect(_listener: &Endpoint, _connector: &Endpoint) -> (ToRequester, ToReplier) {
    let (request, requests) = pipe(IN_FLIGHT);
    let (reply, replies) = pipe(usize::MAX);
    let to_requester = ToRequester { requests, replies: Arc::new(reply), envelopes: BytesMut::new() };
    (to_requester, ToReplier { requests: request, replies })
}

pub(super) struct MemoryRequester {
    connector: Connector<ToRequester, ToReplier>,
    replier: Option<ToReplier>,
}

impl MemoryRequester {
    pub(super) fn new(connector: Connector<ToRequester, ToReplier>) -> Self {
        Self { connector, replier: None }
    }

    fn disconnect(&mut self) {
        self.replier = None;
        self.connector.connect_again();
    }
}

impl Requester for MemoryRequester {
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            let Some(replier) = &self.replier else {
                self.replier = Some(ready!(self.connector.poll_connection(cx)));
                continue;
            };
            match replier.replies.poll_recv(cx) {
                Poll::Ready(Some(answer)) if fits(&answer, self.connector.endpoint.max_size) => {}
                Poll::Ready(_) => self.disconnect(),
                Poll::Pending if replier.requests.has_room(cx) => return Poll::Ready(()),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn request(&mut self, cx: &mut Context<'_>, id: u64, body: Bytes) -> Result<(), Bytes> {
        let Some(replier) = &self.replier else { return Err(body) };
        replier.requests.send(cx, Numbered { id, body }, None).map_err(|refused| refused.body)
    }

    fn is_connected(&self) -> bool {
        self.replier.as_ref().is_some_and(ToReplier::is_open) || self.connector.has_connection(ToReplier::is_open)
    }

    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer> {
        let Some(replier) = &self.replier else { return Poll::Ready(Answer::Lost) };
        Poll::Ready(match ready!(replier.replies.poll_recv(cx)) {
            Some(answer) if fits(&answer, self.connector.endpoint.max_size) => answer,
            _ => {
                self.disconnect();
                Answer::Lost
            }
        })
    }

    fn refusal(&self) -> Option<String> {
        self.connector.refusal()
    }
}

impl ToReplier {
    fn is_open(&self) -> bool {
        self.replies.is_open()
    }
}

pub(super) struct MemoryReplier {
    listener: Listener<ToRequester, ToReplier>,
    requesters: RoundRobin<ToRequester>,
}

impl MemoryReplier {
    pub(super) fn new(listener: Listener<ToRequester, ToReplier>) -> Self {
        Self { listener, requesters: RoundRobin::new(1) }
    }
}

impl Replier for MemoryReplier {
    fn poll_request(&mut self, cx: &mut Context<'_>) -> Poll<IncomingRequest> {
        self.drive(cx);
        let max_size = self.listener.endpoint.max_size;
        self.requesters.poll(|requester| {
            let request = requester.requests.poll_recv(cx);
            // Returning `None` removes the requester and thereby disconnects it.
            request
                .map(|request| request.filter(|request| request.body.len() <= max_size).map(|it| requester.receive(it)))
        })
    }

    /// Always returns true, because what was sent can be received even after this end is dropped.
    fn drive(&mut self, cx: &mut Context<'_>) -> bool {
        while let Poll::Ready(requester) = self.listener.poll_connection(cx) {
            self.requesters.connections.push(requester);
        }
        true
    }

    fn peers(&self) -> usize {
        let open = self.requesters.connections.iter().filter(|requester| requester.is_open()).count();
        open + self.listener.count(ToRequester::is_open)
    }
}

impl ToRequester {
    fn is_open(&self) -> bool {
        self.requests.is_open()
    }

    fn receive(&mut self, request: Numbered) -> IncomingRequest {
        // Envelopes are split off a larger buffer, which is reused once they are dropped.
        self.envelopes.put_u64(request.id);
        let envelope = self.envelopes.split().freeze();
        let path = Arc::clone(&self.replies);
        IncomingRequest { body: request.body, envelope, path }
    }
}

/// Tells the requester and the holders of unanswered requests that the replier is gone.
impl Drop for ToRequester {
    fn drop(&mut self) {
        self.replies.close();
    }
}

impl ReplyPath for PipeWriter<Answer> {
    fn reply(&self, envelope: &Bytes, body: Bytes) -> Result<(), RequesterGone> {
        self.answer(envelope, |id| Answer::Reply { id, body })
    }

    fn refuse(&self, envelope: &Bytes) {
        // A requester that is gone need not be told.
        let _told = self.answer(envelope, |id| Answer::Refused { id });
    }
}

impl PipeWriter<Answer> {
    fn answer(&self, envelope: &Bytes, answer: impl FnOnce(u64) -> Answer) -> Result<(), RequesterGone> {
        let id = envelope[..].try_into().map(u64::from_be_bytes).map_err(|_not_from_here| RequesterGone)?;
        let cx = Context::from_waker(Waker::noop());
        self.send(&cx, answer(id), None).map_err(|_gone| RequesterGone)
    }
}
