//! One subscriber at a publishing end.

use super::stream::Stream;
use super::zmtp::{Header, Hearing, Word, hello, pong};
use bytes::{Buf, Bytes};
use std::collections::VecDeque;
use std::io::{self, IoSlice};
use std::task::{Context, Poll};

/// To how much one may subscribe. SCL's own subscribe to everything, once.
const TOPICS: usize = 1024;
/// How many pieces may wait for one that reads slowly: a batch of messages, and answers to its heartbeats.
const PIECES: usize = 64;

pub(super) struct Subscriber {
    stream: Stream,
    hearing: Hearing,
    /// Whether it has said that it is a subscriber.
    ready: bool,
    topics: Vec<Bytes>,
    /// What the operating system has not taken yet: whole frames but for the first, of which some may be written.
    unwritten: VecDeque<Bytes>,
}

impl Subscriber {
    pub(super) fn of(stream: Stream) -> Self {
        let unwritten = VecDeque::from([hello("XPUB").into()]);
        Self { stream, hearing: Hearing::default(), ready: false, topics: Vec::new(), unwritten }
    }

    /// Whether it has introduced itself; who has not may be anybody.
    pub(super) fn is_ready(&self) -> bool {
        self.ready
    }

    pub(super) fn is_subscribed(&self) -> bool {
        self.ready && !self.topics.is_empty()
    }

    /// Whether all messages are for it, whatever they begin with.
    pub(super) fn wants_all(&self) -> bool {
        self.topics.iter().any(Bytes::is_empty)
    }

    pub(super) fn wants(&self, message: &[u8]) -> bool {
        self.topics.iter().any(|topic| message.starts_with(topic))
    }

    /// Whether everything that it was given is with the operating system.
    pub(super) fn is_written(&self) -> bool {
        self.unwritten.is_empty()
    }

    /// Hears what it says, and writes on.
    ///
    /// # Errors
    /// It is gone, or speaks nonsense.
    pub(super) fn drive(&mut self, cx: &mut Context<'_>) -> io::Result<()> {
        while let Poll::Ready(read) = self.stream.poll_read(cx, self.hearing.memory()) {
            if read? == 0 {
                return Err(io::ErrorKind::UnexpectedEof.into());
            }
            while let Some(word) = self.hearing.next_word().map_err(io::Error::other)? {
                self.obey(word)?;
            }
        }
        self.write_on(cx)
    }

    fn obey(&mut self, word: Word) -> io::Result<()> {
        match word {
            Word::Ready => self.ready = true,
            Word::Subscribe(topic) if self.topics.len() < TOPICS => self.topics.push(topic),
            Word::Subscribe(_) => return Err(io::Error::other("it subscribed to too much")),
            Word::Cancel(topic) => {
                if let Some(place) = self.topics.iter().position(|known| *known == topic) {
                    self.topics.swap_remove(place);
                }
            }
            Word::Ping(context) if self.unwritten.len() < PIECES => self.unwritten.push_back(pong(&context)),
            Word::Ping(_) => return Err(io::Error::other("it asks and does not listen")),
        }
        Ok(())
    }

    /// Writes a message, or keeps what the operating system does not take. To be called when [`Self::is_written`].
    ///
    /// # Errors
    /// It is gone.
    pub(super) fn write_message(&mut self, cx: &mut Context<'_>, message: &Bytes) -> io::Result<()> {
        let header = Header::of(message);
        let header = header.as_bytes();
        let parts = [IoSlice::new(header), IoSlice::new(message)];
        let written = match self.stream.poll_write(cx, &parts) {
            Poll::Ready(written) => written?,
            Poll::Pending => 0,
        };
        if written < header.len() {
            self.unwritten.push_back(Bytes::copy_from_slice(&header[written..]));
        }
        let of_message = written.saturating_sub(header.len());
        if of_message < message.len() || written < header.len() {
            self.unwritten.push_back(message.slice(of_message..));
            return self.write_on(cx);
        }
        Ok(())
    }

    /// The same for frames that are encoded already.
    ///
    /// # Errors
    /// It is gone.
    pub(super) fn write_frames(&mut self, cx: &mut Context<'_>, frames: Bytes) -> io::Result<()> {
        self.unwritten.push_back(frames);
        self.write_on(cx)
    }

    /// Writes what is left, until nothing is, or the task will be woken when there is room.
    fn write_on(&mut self, cx: &mut Context<'_>) -> io::Result<()> {
        while let Some(first) = self.unwritten.front_mut() {
            if first.is_empty() {
                self.unwritten.pop_front();
                continue;
            }
            match self.stream.poll_write(cx, &[IoSlice::new(first)]) {
                Poll::Ready(written) => first.advance(written?),
                Poll::Pending => break,
            }
        }
        Ok(())
    }
}
