//! The requesting end: a DEALER that numbers its requests.
//!
//! The library's REQ never recovers from a peer that restarts. A DEALER that sends `[number, empty, body]` is to any
//! REP or ROUTER an ordinary requester behind a router: the frames up to the empty one come back with the reply, so a
//! late reply is never taken for a newer one.

use super::dial::Dials;
use super::frames::poll_message;
use super::line::Line;
use crate::place::SystemDir;
use crate::transport::{Answer, Asker};
use bytes::Bytes;
use std::sync::Arc;
use std::task::{Context, Poll, Waker};
use zeromq::{DealerSocket, SocketSend, ZmqMessage};

pub(super) struct Requesting {
    line: Line<DealerSocket>,
}

impl Requesting {
    pub(super) fn open(place: &Arc<SystemDir>, endpoint: &str) -> Self {
        Self { line: Line::open(place, endpoint) }
    }
}

impl Dials for DealerSocket {}

impl Asker for Requesting {
    fn poll_connected(&mut self, cx: &mut Context<'_>) -> Poll<()> {
        loop {
            let Poll::Ready(dialled) = self.line.poll_socket(cx) else { return Poll::Pending };
            // A peer that left is noticed only by looking for what it sends; nothing that comes now is still wanted.
            match poll_message(&mut dialled.socket, cx) {
                Poll::Ready(Ok(_stale)) => continue,
                Poll::Ready(Err(_)) => {}
                Poll::Pending if dialled.poll_lost(cx).is_pending() => return Poll::Ready(()),
                Poll::Pending => {}
            }
            self.line.lost();
        }
    }

    fn ask(&mut self, id: u64, body: Bytes) -> Result<(), Bytes> {
        let mut cx = Context::from_waker(Waker::noop());
        let Poll::Ready(dialled) = self.line.poll_socket(&mut cx) else { return Err(body) };
        let mut message = ZmqMessage::from(Bytes::copy_from_slice(&id.to_be_bytes()));
        message.push_back(Bytes::new());
        message.push_back(body.clone());
        // The library only queues here; its writer runs as a task of its own.
        match dialled.socket.send(message).as_mut().poll(&mut cx) {
            Poll::Ready(Ok(())) => Ok(()),
            Poll::Ready(Err(_)) | Poll::Pending => Err(body),
        }
    }

    fn is_connected(&self) -> bool {
        self.line.is_connected()
    }

    fn poll_answer(&mut self, cx: &mut Context<'_>) -> Poll<Answer> {
        loop {
            let Poll::Ready(dialled) = self.line.poll_socket(cx) else { return Poll::Ready(Answer::Lost) };
            match poll_message(&mut dialled.socket, cx) {
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
