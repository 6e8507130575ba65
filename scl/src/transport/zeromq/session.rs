//! One session with a peer: a stream, the decoder of what arrives, and what has not been written yet.

use super::stream::{Stream, is_blocked};
use super::zmtp::{Command, Decoder, Item, ProtocolError, pong};
use bytes::{Buf, Bytes};
use rustix::event::{PollFd, PollFlags, Timespec, poll};
use scl_plan::memory::limits::{PIECES_OF_A_MESSAGE, UNREAD_BYTES, UNREAD_PIECES as PIECES};
use std::collections::VecDeque;
use std::io::{self, IoSlice};
use std::task::{Context, Poll, ready};
use std::time::Duration;

/// Messages up to this length are copied behind their header and written by the simpler system call.
const COPIED: usize = 128;

/// Why a connection is over.
#[derive(Debug, thiserror::Error)]
pub(super) enum Closed {
    #[error("the peer disconnected")]
    Eof,
    #[error(transparent)]
    Io(#[from] io::Error),
    #[error(transparent)]
    Protocol(#[from] ProtocolError),
    #[error("the peer did not complete the handshake in time")]
    SilentPeer,
}

pub(super) struct Session {
    stream: Stream,
    pub(super) decoder: Decoder,
    /// What the operating system has not taken yet; the first piece may be written in part.
    unwritten: VecDeque<Bytes>,
    unwritten_bytes: usize,
    /// Whether the last read left nothing behind in the socket.
    emptied: bool,
}

impl Session {
    /// Starts the handshake on a new stream.
    pub(super) fn new(stream: Stream, decoder: Decoder, hello: &Bytes) -> Self {
        let unwritten = VecDeque::new();
        let mut session = Self { stream, decoder, unwritten, unwritten_bytes: 0, emptied: false };
        // If the stream is already broken, reading it reports that.
        let _reported_by_reading = session.write_shared(hello.clone());
        session
    }

    pub(super) fn detach(&mut self) {
        self.stream.detach();
    }

    /// Returns the next item that the peer has sent, and answers its heartbeats.
    pub(super) fn poll_item(&mut self, cx: &mut Context<'_>) -> Poll<Result<Item, Closed>> {
        loop {
            if let Some(item) = self.buffered_item()? {
                return Poll::Ready(Ok(item));
            }
            ready!(self.poll_fill(cx))?;
        }
    }

    /// Returns the next item without reading from the socket.
    pub(super) fn buffered_item(&mut self) -> Result<Option<Item>, Closed> {
        loop {
            match self.decoder.next_item()? {
                Some(Item::Command(Command::Ping(context))) => self.answer(&context)?,
                Some(Item::Command(Command::Error(reason))) => return Err(ProtocolError::Refused(reason).into()),
                item => return Ok(item),
            }
        }
    }

    fn answer(&mut self, context: &[u8]) -> Result<(), Closed> {
        if self.unwritten.len() >= PIECES {
            return Err(ProtocolError::NotReading.into());
        }
        // A peer that has just left may still have sent messages, so reading goes on.
        let _reported_by_reading = self.write(&pong(context));
        Ok(())
    }

    /// Reads once.
    pub(super) fn poll_fill(&mut self, cx: &mut Context<'_>) -> Poll<Result<(), Closed>> {
        let buffer = self.decoder.room();
        let room = buffer.capacity() - buffer.len();
        let read = ready!(self.stream.poll_read(cx, buffer))?;
        self.emptied = read < room;
        Poll::Ready(if read == 0 { Err(Closed::Eof) } else { Ok(()) })
    }

    /// Reads once without the runtime. Returns false if nothing has arrived.
    pub(super) fn fill_raw(&mut self) -> Result<bool, Closed> {
        let read = self.stream.read(self.decoder.room());
        if is_blocked(&read) {
            return Ok(false);
        }
        if read? == 0 { Err(Closed::Eof) } else { Ok(true) }
    }

    /// Waits on the calling thread until something has arrived. Returns false if nothing has within the given time.
    pub(super) fn wait_readable(&self, within: Duration) -> bool {
        let Ok(timeout) = Timespec::try_from(within) else { return false };
        let mut descriptors = [PollFd::from_borrowed_fd(self.stream.as_fd(), PollFlags::IN)];
        matches!(poll(&mut descriptors, Some(&timeout)), Ok(1..))
    }

    /// The same, and then reads what has arrived, without the runtime.
    pub(super) fn wait(&mut self, within: Duration) -> bool {
        // A broken connection is also reported by the next poll.
        self.is_written() && self.wait_readable(within) && matches!(self.fill_raw(), Ok(true))
    }

    /// Returns true once after a read that left nothing behind in the socket.
    pub(super) fn take_emptied(&mut self) -> bool {
        std::mem::take(&mut self.emptied)
    }

    /// Whether everything that a peer has written can be read at once.
    pub(super) fn is_immediate(&self) -> bool {
        self.stream.is_immediate()
    }

    pub(super) fn is_written(&self) -> bool {
        self.unwritten.is_empty()
    }

    /// Returns true if too much waits for a requester or replier that does not read, which is then disconnected. The
    /// given number of messages may always wait, however long they are.
    pub(super) fn is_unread(&self, messages: usize) -> bool {
        let has_room = self.unwritten.len() < messages.saturating_mul(PIECES_OF_A_MESSAGE);
        !has_room && (self.unwritten.len() >= PIECES || self.unwritten_bytes >= UNREAD_BYTES)
    }

    /// Writes encoded frames, or keeps what the operating system does not take.
    pub(super) fn write(&mut self, frames: &[u8]) -> io::Result<()> {
        let written = if self.is_written() { none_if_blocked(self.stream.write(frames))? } else { 0 };
        self.keep(&frames[written..]);
        Ok(())
    }

    /// The same without copying what is kept.
    pub(super) fn write_shared(&mut self, mut frames: Bytes) -> io::Result<()> {
        if self.is_written() {
            frames.advance(none_if_blocked(self.stream.write(&frames))?);
        }
        self.keep_shared(frames);
        Ok(())
    }

    /// Writes a message: encoded frames, the header of the last frame, and its body.
    pub(super) fn write_message(&mut self, frames: &[u8], header: &[u8], body: &Bytes) -> io::Result<()> {
        let before = frames.len() + header.len();
        let mut written = 0;
        if self.is_written() {
            written = none_if_blocked(self.send_message(frames, header, body))?;
            if written == before + body.len() {
                return Ok(());
            }
        }
        self.keep(frames.get(written..).unwrap_or_default());
        self.keep(header.get(written.saturating_sub(frames.len())..).unwrap_or_default());
        self.keep_shared(body.slice(written.saturating_sub(before)..));
        Ok(())
    }

    fn send_message(&self, frames: &[u8], header: &[u8], body: &[u8]) -> io::Result<usize> {
        let length = frames.len() + header.len() + body.len();
        if length > COPIED {
            return self.stream.write_vectored(&[IoSlice::new(frames), IoSlice::new(header), IoSlice::new(body)]);
        }
        let mut copy = [0; COPIED];
        let (first, rest) = copy.split_at_mut(frames.len());
        let (second, third) = rest.split_at_mut(header.len());
        first.copy_from_slice(frames);
        second.copy_from_slice(header);
        third[..body.len()].copy_from_slice(body);
        self.stream.write(&copy[..length])
    }

    fn keep(&mut self, bytes: &[u8]) {
        if !bytes.is_empty() {
            self.keep_shared(Bytes::copy_from_slice(bytes));
        }
    }

    fn keep_shared(&mut self, bytes: Bytes) {
        if !bytes.is_empty() {
            self.unwritten_bytes += bytes.len();
            self.unwritten.push_back(bytes);
        }
    }

    /// Continues writing, until everything is written or the task will be woken.
    pub(super) fn flush(&mut self, cx: &mut Context<'_>) -> io::Result<()> {
        while let Some(first) = self.unwritten.front_mut() {
            match self.stream.poll_write(cx, first) {
                Poll::Ready(written) => self.count_written(written?),
                Poll::Pending => break,
            }
        }
        Ok(())
    }

    /// Continues writing without the runtime. Wakes no task.
    pub(super) fn flush_raw(&mut self) -> io::Result<()> {
        while let Some(first) = self.unwritten.front_mut() {
            match none_if_blocked(self.stream.write(first))? {
                0 => break,
                written => self.count_written(written),
            }
        }
        Ok(())
    }

    fn count_written(&mut self, written: usize) {
        self.unwritten_bytes -= written;
        if let Some(first) = self.unwritten.front_mut() {
            first.advance(written);
            if first.is_empty() {
                self.unwritten.pop_front();
            }
        }
    }
}

fn none_if_blocked(written: io::Result<usize>) -> io::Result<usize> {
    if is_blocked(&written) { Ok(0) } else { written }
}
