//! Messages of the library, one poll at a time.

use bytes::Bytes;
use std::task::{Context, Poll};
use zeromq::{SocketRecv, ZmqMessage, ZmqResult};

/// Asks a socket once for a message. Dropping the library's future after one poll loses nothing: what was read stays
/// in the socket.
pub(super) fn poll_message(socket: &mut impl SocketRecv, cx: &mut Context<'_>) -> Poll<ZmqResult<ZmqMessage>> {
    socket.recv().as_mut().poll(cx)
}

/// The message, if it is one frame, as every message of SCL is.
pub(super) fn single_frame(message: ZmqMessage) -> Option<Bytes> {
    let mut frames = message.into_vecdeque();
    let first = frames.pop_front()?;
    frames.is_empty().then_some(first)
}
