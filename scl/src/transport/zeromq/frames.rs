//! Messages of the library, one poll at a time.

use bytes::Bytes;
use std::task::{Context, Poll, ready};
use tokio_util::sync::ReusableBoxFuture;
use zeromq::{SocketRecv, ZmqMessage, ZmqResult};

/// What a socket receives. One future is kept from poll to poll, in memory that is used again for the next message: a
/// future made anew for each poll takes memory each time.
pub(super) struct Messages<S> {
    /// The socket comes and goes in a box, because it is moved with each message.
    next: ReusableBoxFuture<'static, (Box<S>, ZmqResult<ZmqMessage>)>,
}

impl<S: SocketRecv + Send + 'static> Messages<S> {
    pub(super) fn of(socket: S) -> Self {
        Self { next: ReusableBoxFuture::new(receive(Box::new(socket))) }
    }

    /// Ready again and again; after an error too.
    pub(super) fn poll(&mut self, cx: &mut Context<'_>) -> Poll<ZmqResult<ZmqMessage>> {
        let (socket, received) = ready!(self.next.poll(cx));
        self.next.set(receive(socket));
        Poll::Ready(received)
    }
}

async fn receive<S: SocketRecv + Send>(mut socket: Box<S>) -> (Box<S>, ZmqResult<ZmqMessage>) {
    let received = socket.recv().await;
    (socket, received)
}

/// The message, if it is one frame, as every message of SCL is.
pub(super) fn single_frame(message: ZmqMessage) -> Option<Bytes> {
    let mut frames = message.into_vecdeque();
    let first = frames.pop_front()?;
    frames.is_empty().then_some(first)
}
