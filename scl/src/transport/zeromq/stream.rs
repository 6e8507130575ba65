//! Connected sockets of both transports.
//!
//! Writes go to the operating system directly, and involve the runtime only when the socket is full. Reads go through
//! the runtime, which knows without a system call that nothing has arrived; the raw variant is for callers that cannot
//! wait until the runtime polls the socket.

use bytes::BytesMut;
use rustix::net::{RecvFlags, SendAncillaryBuffer, SendFlags};
use std::io::{self, IoSlice};
use std::mem::MaybeUninit;
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::pin::pin;
use std::task::{Context, Poll, ready};
use tokio::io::{AsyncReadExt, Interest};
use tokio::net::{TcpStream, UnixStream};

/// Maximum number of bytes of one raw read; they pass through a buffer on the stack.
const RAW_READ: usize = 16 << 10;
/// A closed peer is an error to be returned, not a signal that ends the program.
const SEND: SendFlags = SendFlags::NOSIGNAL.union(SendFlags::DONTWAIT);

pub(super) enum Socket {
    Unix(UnixStream),
    Tcp(TcpStream),
    /// Not registered with any runtime.
    Plain(OwnedFd),
}

pub(super) struct Stream {
    socket: Socket,
    /// Whether the runtime must no longer be used.
    detached: bool,
}

impl Stream {
    pub(super) fn new(socket: Socket) -> Self {
        let detached = matches!(socket, Socket::Plain(_));
        Self { socket, detached }
    }

    /// Makes only raw system calls from now on.
    pub(super) fn detach(&mut self) {
        self.detached = true;
    }

    /// Whether everything that a peer has written can be read at once. TCP may hold it back for a while.
    pub(super) fn is_immediate(&self) -> bool {
        matches!(self.socket, Socket::Unix(_))
    }

    pub(super) fn as_fd(&self) -> BorrowedFd<'_> {
        match &self.socket {
            Socket::Unix(stream) => stream.as_fd(),
            Socket::Tcp(stream) => stream.as_fd(),
            Socket::Plain(descriptor) => descriptor.as_fd(),
        }
    }

    /// Appends what has arrived. Returns 0 at the end of the stream.
    pub(super) fn poll_read(&mut self, cx: &mut Context<'_>, into: &mut BytesMut) -> Poll<io::Result<usize>> {
        match &mut self.socket {
            Socket::Unix(stream) if !self.detached => pin!(stream.read_buf(into)).poll(cx),
            Socket::Tcp(stream) if !self.detached => pin!(stream.read_buf(into)).poll(cx),
            _ => pending_if_blocked(self.read(into)),
        }
    }

    /// The same without the runtime; fails with `WouldBlock` if nothing has arrived.
    pub(super) fn read(&self, into: &mut BytesMut) -> io::Result<usize> {
        let mut scratch = [MaybeUninit::uninit(); RAW_READ];
        let ((arrived, _), _) = rustix::net::recv(self.as_fd(), &mut scratch[..], RecvFlags::DONTWAIT)?;
        into.extend_from_slice(arrived);
        Ok(arrived.len())
    }

    /// Writes as much as the operating system takes at once; fails with `WouldBlock` if that is nothing.
    pub(super) fn write(&self, bytes: &[u8]) -> io::Result<usize> {
        Ok(rustix::net::send(self.as_fd(), bytes, SEND)?)
    }

    pub(super) fn write_vectored(&self, parts: &[IoSlice<'_>]) -> io::Result<usize> {
        Ok(rustix::net::sendmsg(self.as_fd(), parts, &mut SendAncillaryBuffer::default(), SEND)?)
    }

    /// Writes as [`write`](Self::write) does, and wakes the task when the operating system takes more.
    pub(super) fn poll_write(&self, cx: &mut Context<'_>, bytes: &[u8]) -> Poll<io::Result<usize>> {
        if self.detached {
            return pending_if_blocked(self.write(bytes));
        }
        loop {
            let written = match &self.socket {
                Socket::Unix(stream) => {
                    ready!(stream.poll_write_ready(cx))?;
                    stream.try_io(Interest::WRITABLE, || self.write(bytes))
                }
                Socket::Tcp(stream) => {
                    ready!(stream.poll_write_ready(cx))?;
                    stream.try_io(Interest::WRITABLE, || self.write(bytes))
                }
                Socket::Plain(_) => self.write(bytes),
            };
            if !is_blocked(&written) {
                return Poll::Ready(written);
            }
        }
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        // Closing a TCP socket with unread data discards what the peer has not received yet.
        let is_tcp = matches!(&self.socket, Socket::Tcp(_) | Socket::Plain(_));
        let mut scratch = [MaybeUninit::uninit(); 4096];
        let mut read =
            || is_tcp && matches!(rustix::net::recv(self.as_fd(), &mut scratch[..], RecvFlags::DONTWAIT), Ok((_, 1..)));
        let _is_more_left = (0..64).all(|_| read());
    }
}

pub(super) fn is_blocked<T>(result: &io::Result<T>) -> bool {
    matches!(result, Err(error) if error.kind() == io::ErrorKind::WouldBlock)
}

fn pending_if_blocked<T>(result: io::Result<T>) -> Poll<io::Result<T>> {
    if is_blocked(&result) { Poll::Pending } else { Poll::Ready(result) }
}
