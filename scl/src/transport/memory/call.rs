//! The roles that ask and answer.

use super::IN_FLIGHT;
use super::flow::poll_in_turn;
use super::meeting::Present;
use super::pipe::{Receiver, Sender, pipe};
use crate::transport::{Answer, Answerer, Asked, Asker, RequesterGone, Responder};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll};

/// A request or a reply, under its number.
struct Numbered {
    id: u64,
    body: Bytes,
}

/// A connection to its replier.
pub(super) struct Dialogue {
    requests: Receiver<Numbered>,
    /// Shared with the requests that are not answered yet.
    replies: Arc<Sender<Numbered>>,
}

/// A connection to its requester.
pub(super) struct Line {
    requests: Sender<Numbered>,
    replies: Receiver<Numbered>,
}

/// Replies have no bound of their own: each belongs to a request, and a requester drops old ones before it asks again.
pub(super) fn connect() -> (Dialogue, Line) {
    let (asking, requests) = pipe(IN_FLIGHT);
    let (answering, replies) = pipe(usize::MAX);
    (Dialogue { requests, replies: Arc::new(answering) }, Line { requests: asking, replies })
}

impl Line {
    fn is_open(&self) -> bool {
        self.replies.is_open()
    }
}

/// The replier is gone, also for those who hold its unanswered requests.
impl Drop for Dialogue {
    fn drop(&mut self) {
        self.replies.close();
    }
}

pub(super) struct Requesting {
    line: Option<Line>,
    present: Present<Dialogue, Line, Line>,
}

impl Requesting {
    pub(super) fn new(present: Present<Dialogue, Line, Line>) -> Self {
        Self { line: None, present }
    }
}

impl Asker for Requesting {
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            let Some(line) = &self.line else {
                match self.present.poll_connection(cx) {
                    Poll::Ready(line) => self.line = Some(line),
                    Poll::Pending => return Poll::Pending,
                }
                continue;
            };
            match line.replies.poll_recv(cx) {
                // Nothing that comes before the next request is asked is still wanted.
                Poll::Ready(Some(_stale)) => {}
                Poll::Ready(None) => self.line = None,
                Poll::Pending if line.requests.has_room(cx) => return Poll::Ready(()),
                Poll::Pending => return Poll::Pending,
            }
        }
    }

    fn ask(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        let Some(line) = &self.line else { return Err(body) };
        line.requests.send(Numbered { id, body }).map_err(|refused| refused.body)
    }

    fn is_connected(&self) -> bool {
        self.line.as_ref().is_some_and(Line::is_open) || self.present.has_connection(Line::is_open)
    }

    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer> {
        let Some(line) = &self.line else { return Poll::Ready(Answer::Lost) };
        match line.replies.poll_recv(cx) {
            Poll::Ready(Some(Numbered { id, body })) => Poll::Ready(Answer::Reply { id, body }),
            Poll::Ready(None) => {
                self.line = None;
                Poll::Ready(Answer::Lost)
            }
            Poll::Pending => Poll::Pending,
        }
    }
}

pub(super) struct Replying {
    dialogues: Vec<Dialogue>,
    /// The requester to ask first, so that none is kept waiting by another.
    next: usize,
    present: Present<Dialogue, Line, Dialogue>,
}

impl Replying {
    pub(super) fn new(present: Present<Dialogue, Line, Dialogue>) -> Self {
        Self { dialogues: Vec::new(), next: 0, present }
    }
}

impl Answerer for Replying {
    fn poll_asked(&mut self, cx: &mut Context<'_>) -> Poll<Asked> {
        while let Poll::Ready(dialogue) = self.present.poll_connection(cx) {
            self.dialogues.push(dialogue);
        }
        let asked = poll_in_turn(&mut self.dialogues, &mut self.next, |dialogue| {
            let way_back = |id| Box::new(WayBack { id, replies: Arc::clone(&dialogue.replies) });
            dialogue
                .requests
                .poll_recv(cx)
                .map(|request| request.map(|Numbered { id, body }| Asked { body, responder: way_back(id) }))
        });
        asked.map_or(Poll::Pending, Poll::Ready)
    }
}

struct WayBack {
    id: u64,
    replies: Arc<Sender<Numbered>>,
}

impl Responder for WayBack {
    fn respond(self: Box<Self>, body: Bytes) -> Result<(), RequesterGone> {
        self.replies.send(Numbered { id: self.id, body }).map_err(|_refused| RequesterGone)
    }
}
