//! Decoding what a peer sends, from its greeting on.

use super::command::{self, Command, Subscription};
use super::frame::Head;
use super::{PeerReady, ProtocolError, SocketType, greeting, ready};
use bytes::{Buf, Bytes, BytesMut};
use scl_plan::memory::limits::READ as LARGE_CHUNK;

/// Maximum number of frames of a message. SCL's own messages have three at most.
const FRAMES: usize = 16;
/// Maximum length of a command, and maximum by which the frames of a message together may exceed the limit of one
/// message: more than any envelope needs.
const COMMAND_LIMIT: usize = 64 << 10;

/// Memory until the handshake is done, and for peers that send only commands.
const SMALL_CHUNK: usize = 512;
/// Memory for each read from a peer that sends messages; [`LARGE_CHUNK`] while they are long.
const CHUNK: usize = 64 << 10;
/// Memory reserved at once for an incomplete frame, unless more of it has arrived.
const STEP: usize = 1 << 20;

/// A complete handshake, message or command that a peer has sent.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::transport::zeromq) enum Item {
    /// The handshake is done.
    Ready(PeerReady),
    Message(Message),
    Command(Command),
}

impl Item {
    /// Returns the subscription that a subscriber has sent, as a message or as a command.
    pub(in crate::transport::zeromq) fn into_subscription(self) -> Option<Subscription> {
        match self {
            // Multipart messages are not subscriptions; later parts could be mistaken for one.
            Self::Message(message) if message.envelope.is_empty() => command::subscription(message.body),
            Self::Command(Command::Subscription(subscription)) => Some(subscription),
            _ => None,
        }
    }
}

/// A message.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::transport::zeromq) struct Message {
    /// All frames but the last, encoded as they came.
    pub(in crate::transport::zeromq) envelope: Bytes,
    /// The last frame.
    pub(in crate::transport::zeromq) body: Bytes,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stage {
    Greeting,
    Handshake,
    Traffic,
}

/// Bytes received from a peer but not yet decoded.
///
/// Messages and commands that it returns share its memory, which is used again once they have been dropped.
pub(in crate::transport::zeromq) struct Decoder {
    socket: SocketType,
    max_size: u64,
    chunk: usize,
    stage: Stage,
    buffer: BytesMut,
    /// Length of the frames at the front of `buffer` that belong to a message which is not complete.
    parts: usize,
    /// Earlier frames of that message, which a command separated from those in `buffer`.
    earlier_parts: BytesMut,
    /// Number of frames of that message, and the total length of their bodies.
    frames: usize,
    frame_bytes: u64,
    /// Number of bytes without which the next item cannot be complete.
    missing: usize,
    /// Approximate length of the longest recent message.
    typical: usize,
}

impl Decoder {
    /// `max_size` is the longest message that is accepted at a socket that receives messages.
    pub(in crate::transport::zeromq) fn new(socket: SocketType, max_size: usize) -> Self {
        let receives = !matches!(socket, SocketType::XPub | SocketType::Push);
        // Sockets that do not receive messages receive only short commands and subscriptions, whatever the message
        // limit is.
        let max_size = if receives { max_size } else { COMMAND_LIMIT };
        Self {
            socket,
            max_size: (max_size as u64).min(u64::MAX >> 2),
            chunk: if receives { CHUNK } else { SMALL_CHUNK },
            stage: Stage::Greeting,
            buffer: BytesMut::new(),
            parts: 0,
            earlier_parts: BytesMut::new(),
            frames: 0,
            frame_bytes: 0,
            missing: 0,
            typical: 0,
        }
    }

    /// The buffer that received bytes are appended to, with room for some.
    ///
    /// Memory is reserved only in proportion to what has arrived, whatever length the peer has announced.
    pub(in crate::transport::zeromq) fn room(&mut self) -> &mut BytesMut {
        let arrived = self.buffer.len();
        let chunk = self.chunk();
        if arrived == 0 {
            self.typical -= self.typical / 16;
            // Fails while a message that was taken from this memory is still in use.
            if self.buffer.try_reclaim(chunk) && self.buffer.capacity() > 2 * chunk.max(4 * self.typical) {
                self.buffer = BytesMut::new();
            }
        }
        if self.buffer.capacity() - arrived < chunk / 16 {
            self.buffer.reserve(self.missing.min(arrived.max(STEP)).max(chunk));
        }
        &mut self.buffer
    }

    fn chunk(&self) -> usize {
        match self.stage {
            Stage::Greeting | Stage::Handshake => SMALL_CHUNK,
            Stage::Traffic => self.chunk.max((4 * self.typical).min(LARGE_CHUNK)),
        }
    }

    /// Number of received bytes that have not been decoded.
    pub(in crate::transport::zeromq) fn buffered(&self) -> usize {
        self.earlier_parts.len() + self.buffer.len()
    }

    /// Returns true if the next frame to be decoded has arrived only in part.
    pub(in crate::transport::zeromq) fn is_in_frame(&self) -> bool {
        let rest = &self.buffer[self.parts..];
        match Head::parse(rest) {
            Ok(Some(head)) => self.check(&head).is_ok_and(|body| rest.len() < head.header + body),
            Ok(None) => !rest.is_empty(),
            Err(_) => false,
        }
    }

    /// Returns the next item, or `None` if more bytes are needed.
    ///
    /// # Errors
    /// The peer violated the protocol; the decoder is of no further use.
    pub(in crate::transport::zeromq) fn next_item(&mut self) -> Result<Option<Item>, ProtocolError> {
        if self.stage == Stage::Greeting {
            if !greeting::check(&self.buffer)? {
                return Ok(None);
            }
            self.buffer.advance(greeting::LENGTH);
            self.stage = Stage::Handshake;
        }
        loop {
            let rest = &self.buffer[self.parts..];
            let Some(head) = Head::parse(rest)? else {
                self.missing = 1;
                return Ok(None);
            };
            let body = self.check(&head)?;
            let frame = head.header + body;
            if rest.len() < frame {
                self.missing = frame - rest.len();
                return Ok(None);
            }
            if head.is_command() {
                let body = self.take_command(frame, head.header);
                return self.handle_command(body).map(Some);
            }
            if self.stage != Stage::Traffic {
                return Err(ProtocolError::NotReady);
            }
            if !head.has_more() {
                return Ok(Some(Item::Message(self.take_message(head.header, body))));
            }
            self.parts += frame;
            self.frames += 1;
            self.frame_bytes += body as u64;
        }
    }

    /// Returns the length of the frame's body if it may be as long as announced.
    fn check(&self, head: &Head) -> Result<usize, ProtocolError> {
        let too_long = |limit| Err(ProtocolError::TooLong { announced: head.body, limit });
        if head.is_command() {
            if head.has_more() {
                return Err(ProtocolError::MalformedCommand);
            }
            if head.body > COMMAND_LIMIT as u64 {
                return too_long(COMMAND_LIMIT as u64);
            }
            return Ok(head.body as usize);
        }
        if head.body > self.max_size {
            return too_long(self.max_size);
        }
        if self.frames > 0 || head.has_more() {
            if self.frames + 1 + usize::from(head.has_more()) > FRAMES {
                return Err(ProtocolError::TooManyFrames { limit: FRAMES });
            }
            // Neither sum can overflow: see `new`.
            if self.frame_bytes + head.body > self.max_size + COMMAND_LIMIT as u64 {
                return too_long(self.max_size + COMMAND_LIMIT as u64 - self.frame_bytes);
            }
        }
        Ok(head.body as usize)
    }

    fn take_message(&mut self, header: usize, body: usize) -> Message {
        let envelope = if self.frames == 0 { Bytes::new() } else { self.take_envelope() };
        self.typical = self.typical.max(body);
        self.buffer.advance(header);
        let body = if body == 0 { Bytes::new() } else { self.buffer.split_to(body).freeze() };
        Message { envelope, body }
    }

    fn take_envelope(&mut self) -> Bytes {
        let parts = self.buffer.split_to(std::mem::take(&mut self.parts));
        (self.frames, self.frame_bytes) = (0, 0);
        if self.earlier_parts.is_empty() {
            return parts.freeze();
        }
        let mut envelope = std::mem::take(&mut self.earlier_parts);
        envelope.unsplit(parts);
        envelope.freeze()
    }

    /// Takes a command from behind the frames of a message that is not complete; libzmq puts its heartbeats there.
    fn take_command(&mut self, frame: usize, header: usize) -> Bytes {
        if self.parts > 0 {
            let parts = self.buffer.split_to(std::mem::take(&mut self.parts));
            self.earlier_parts.unsplit(parts);
        }
        let mut command = self.buffer.split_to(frame).freeze();
        command.advance(header);
        command
    }

    fn handle_command(&mut self, body: Bytes) -> Result<Item, ProtocolError> {
        if self.stage == Stage::Traffic {
            return Command::parse(body).map(Item::Command);
        }
        let (name, content) = command::split(body)?;
        match &*name {
            b"READY" => {
                let peer = ready::parse(self.socket, &content)?;
                self.stage = Stage::Traffic;
                Ok(Item::Ready(peer))
            }
            b"ERROR" => Err(ProtocolError::Refused(command::error_text(&content))),
            _ => Err(ProtocolError::NotReady),
        }
    }
}
