//! The requesting end: a DEALER socket that numbers its requests.
//!
//! A request is `[number, empty, body]`. To any REP or ROUTER socket this looks like an ordinary requester behind a
//! router: the frames up to the empty one come back with the reply, so a late reply is never taken for a newer one.

use super::dialler::Dialler;
use super::session::{Closed, Session};
use super::zmtp::{Command, Header, Item, MORE, Message, SclReady, SocketType, bodies};
use crate::runtime_dir::SystemDir;
use crate::transport::{Answer, Endpoint, Requester};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, ready};
use std::time::Duration;

pub(super) struct Caller {
    dialler: Dialler,
    replier: Option<Session>,
    /// How many requests may be without a reply, if more than one.
    in_flight: usize,
}

impl Caller {
    pub(super) fn open(dir: &Arc<SystemDir>, endpoint: &Endpoint) -> Self {
        let in_flight = Some(endpoint.in_flight).filter(|&requests| requests > 1);
        let ready = SclReady { in_flight, ..SclReady::default() };
        let dialler = Dialler::new(dir, endpoint, SocketType::Dealer, ready);
        Self { dialler, replier: None, in_flight: in_flight.unwrap_or(0) }
    }

    /// Returns the next reply or refusal over the current connection.
    fn poll_reply(replier: &mut Session, cx: &mut Context<'_>) -> Poll<Result<Answer, Closed>> {
        if !replier.is_written() {
            replier.flush(cx)?;
        }
        loop {
            match ready!(replier.poll_item(cx))? {
                Item::Message(message) => match numbered(message) {
                    Some((id, body)) => return Poll::Ready(Ok(Answer::Reply { id, body })),
                    None => tracing::warn!("ignoring a reply without the number of its request"),
                },
                Item::Command(Command::Refused(id)) => return Poll::Ready(Ok(Answer::Refused { id })),
                Item::Command(_) | Item::Ready(_) => {}
            }
        }
    }

    fn lose(&mut self, error: &Closed) {
        tracing::debug!(endpoint = %self.dialler.endpoint.name, %error, "lost the replier");
        self.replier = None;
    }

    fn try_request(
        replier: &mut Session,
        in_flight: usize,
        cx: &mut Context<'_>,
        id: u64,
        body: &Bytes,
    ) -> Result<(), Closed> {
        if replier.is_unread(in_flight) {
            return Err(super::zmtp::ProtocolError::NotReading.into());
        }
        replier.write_message(&envelope(id), Header::new(0, body.len()).as_bytes(), body)?;
        Ok(replier.flush(cx)?)
    }
}

impl Requester for Caller {
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            let Some(replier) = &mut self.replier else {
                let (session, _) = ready!(self.dialler.poll_connected(cx));
                self.replier = Some(session);
                continue;
            };
            match Self::poll_reply(replier, cx) {
                Poll::Ready(Ok(_too_late)) => {}
                Poll::Ready(Err(error)) => self.lose(&error),
                Poll::Pending => return Poll::Ready(()),
            }
        }
    }

    fn request(&mut self, cx: &mut Context<'_>, id: u64, body: Bytes) -> Result<(), Bytes> {
        let Some(replier) = &mut self.replier else { return Err(body) };
        Self::try_request(replier, self.in_flight, cx, id, &body).map_err(|error| {
            self.lose(&error);
            body
        })
    }

    fn is_connected(&self) -> bool {
        self.replier.is_some()
    }

    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer> {
        let Some(replier) = &mut self.replier else { return Poll::Ready(Answer::Lost) };
        Poll::Ready(ready!(Self::poll_reply(replier, cx)).unwrap_or_else(|error| {
            self.lose(&error);
            Answer::Lost
        }))
    }

    fn wait(&mut self, within: Duration) -> bool {
        self.replier.as_mut().is_some_and(|replier| replier.wait(within))
    }

    fn refusal(&self) -> Option<String> {
        self.dialler.refusal()
    }
}

/// The frames in front of a request: its number and the empty one.
fn envelope(id: u64) -> [u8; 12] {
    let mut envelope = [0; 12];
    envelope[..2].copy_from_slice(&[MORE, 8]);
    envelope[2..10].copy_from_slice(&id.to_be_bytes());
    envelope[10] = MORE;
    envelope
}

fn numbered(Message { envelope, body }: Message) -> Option<(u64, Bytes)> {
    let mut frames = bodies(&envelope);
    let number = <[u8; 8]>::try_from(frames.next()?).ok()?;
    let is_delimited = frames.next()?.is_empty() && frames.next().is_none();
    is_delimited.then(|| (u64::from_be_bytes(number), body))
}
