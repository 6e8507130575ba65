//! The requesting end: a DEALER that numbers its requests.
//!
//! The library's REQ never recovers from a peer that restarts. A DEALER that sends `[number, empty, body]` is to any
//! REP or ROUTER an ordinary requester behind a router: the frames up to the empty one come back with the reply, so a
//! late reply is never taken for a newer one.

use super::dial::Dials;
use super::frames::Messages;
use super::line::Line;
use crate::place::SystemDir;
use crate::transport::{Answer, Asker};
use bytes::{BufMut, Bytes, BytesMut};
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use zeromq::{DealerRecvHalf, DealerSendHalf, DealerSocket, SocketSend, ZmqMessage};

/// Memory for the numbers of requests is taken in pieces of this size; a piece is used again when all its numbers are
/// written.
const PIECE: usize = 1024;

pub(super) struct Requesting {
    line: Line<DealerSocket>,
    numbers: BytesMut,
}

/// A connected socket.
pub(super) struct Exchange {
    requests: DealerSendHalf,
    replies: Messages<DealerRecvHalf>,
}

impl Requesting {
    pub(super) fn open(place: &Arc<SystemDir>, endpoint: &str) -> Self {
        Self { line: Line::open(place, endpoint), numbers: BytesMut::new() }
    }

    fn number(&mut self, id: u64) -> Bytes {
        if self.numbers.capacity() < size_of::<u64>() {
            self.numbers.reserve(PIECE);
        }
        self.numbers.put_u64(id);
        self.numbers.split().freeze()
    }
}

impl Dials for DealerSocket {
    type End = Exchange;

    fn into_end(self) -> Exchange {
        let (requests, replies) = self.split();
        Exchange { requests, replies: Messages::of(replies) }
    }
}

impl Asker for Requesting {
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            let Poll::Ready(dialled) = self.line.poll_dialled(cx) else { return Poll::Pending };
            // A peer that left is noticed only by looking for what it sends; nothing that comes now is still wanted.
            match dialled.end.replies.poll(cx) {
                Poll::Ready(Ok(_stale)) => continue,
                Poll::Ready(Err(_)) => {}
                Poll::Pending if dialled.poll_lost(cx).is_pending() => return Poll::Ready(()),
                Poll::Pending => {}
            }
            self.line.lost();
        }
    }

    fn ask(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        let number = self.number(id);
        let Some(dialled) = self.line.dialled() else { return Err(body) };
        let frames = vec![number, Bytes::new(), body.clone()];
        let Ok(message) = ZmqMessage::try_from(frames) else { return Err(body) };
        // The library only queues here; its writer runs as a task of its own.
        match dialled.end.requests.send(message).as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            Poll::Ready(Ok(())) => Ok(()),
            Poll::Ready(Err(_)) | Poll::Pending => Err(body),
        }
    }

    fn is_connected(&self) -> bool {
        self.line.is_connected()
    }

    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer> {
        loop {
            let Poll::Ready(dialled) = self.line.poll_dialled(cx) else { return Poll::Ready(Answer::Lost) };
            match dialled.end.replies.poll(cx) {
                Poll::Ready(Ok(message)) => match numbered(message) {
                    Some((id, body)) => return Poll::Ready(Answer::Reply { id, body }),
                    None => tracing::warn!("a reply without the number of its request was passed over"),
                },
                Poll::Pending if dialled.poll_lost(cx).is_pending() => return Poll::Pending,
                Poll::Ready(Err(_)) | Poll::Pending => {
                    self.line.lost();
                    return Poll::Ready(Answer::Lost);
                }
            }
        }
    }
}

/// Takes `[number, empty, body]` apart.
fn numbered(message: ZmqMessage) -> Option<(u64, Bytes)> {
    let [number, delimiter, body] = <[Bytes; 3]>::try_from(message.into_vec()).ok()?;
    let number = <[u8; 8]>::try_from(&*number).ok()?;
    delimiter.is_empty().then(|| (u64::from_be_bytes(number), body))
}
