//! Commands: subscriptions, heartbeats, and SCL's acknowledgements.

use super::ProtocolError;
use super::frame::{COMMAND, Header};
use crate::transport::Resumed;
use bytes::{Buf, Bytes};

/// The longest context that an answer to a heartbeat repeats.
const CONTEXT: usize = 16;

/// The message by which a 3.0 subscriber subscribes to everything.
pub(in crate::transport::zeromq) const SUBSCRIBE_ALL: &[u8] = b"\0\x01\x01";

/// The same, and a heartbeat whose answer confirms that the subscription is in force.
pub(in crate::transport::zeromq) const SUBSCRIBE_ALL_AND_PING: &[u8] = b"\0\x01\x01\x04\x07\x04PING\0\0";

/// From a sending end: the window is full, and newer messages wait for an acknowledgement.
pub(in crate::transport::zeromq) const BEHIND: &[u8] = b"\x04\x0d\x0cX-SCL-BEHIND";
/// From a sending end: acknowledge everything sent before this.
pub(in crate::transport::zeromq) const FLUSH: &[u8] = b"\x04\x0c\x0bX-SCL-FLUSH";

/// From a receiving end: it has opened the connection's shared memory.
pub(in crate::transport::zeromq) const SHM_OPEN: &[u8] = b"\x04\x0f\x0eX-SCL-SHM-OPEN";
/// From a receiving end: send nothing more over this connection.
pub(in crate::transport::zeromq) const FINISH: &[u8] = b"\x04\x0d\x0cX-SCL-FINISH";
/// From a sending end: nothing more follows.
pub(in crate::transport::zeromq) const FINISHED: &[u8] = b"\x04\x0f\x0eX-SCL-FINISHED";

/// A command of a peer after the handshake.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::transport::zeromq) enum Command {
    Subscription(Subscription),
    /// A heartbeat to be answered with its context.
    Ping(Bytes),
    /// The answer to a heartbeat.
    Pong,
    /// The peer closes the connection for this reason.
    Error(String),
    /// Number of messages that the peer's gate has taken so far, and of those among them that no longer wait there. An
    /// older release does not send the second number.
    Acknowledged {
        taken: u64,
        received: u64,
    },
    /// Newer messages wait for an acknowledgement.
    Behind,
    /// The peer wants to be told when no newer message waits. The answer repeats this number.
    CatchUp(u64),
    /// No newer message waits. The number is that of the last [`CatchUp`](Self::CatchUp), or 0.
    CaughtUp(u64),
    /// The peer requests an acknowledgement of everything that it has sent.
    Flush,
    /// The peer has opened the connection's shared memory, and receives samples from now on.
    ShmOpen,
    /// The peer has put a message into shared memory, which comes before everything sent after this command.
    Sample {
        /// The sample's number, from 1.
        sequence: u64,
        /// Its length in bytes.
        length: u64,
    },
    /// The peer is about to close the connection, and wants nothing more over it.
    Finish,
    /// The peer sends nothing more over this connection.
    Finished,
    /// The peer does not answer the request of this number.
    Refused(u64),
    /// The next message was published this many nanoseconds ago, before this end joined.
    Latched(u64),
    /// The next message was sent at this time of `CLOCK_MONOTONIC`, in nanoseconds.
    Sent(u64),
    /// Which end the peer is, and what it has taken before.
    Resume(Resumed),
    Unknown,
}

/// What a subscriber wants.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::transport::zeromq) enum Subscription {
    /// The subscriber wants messages with this prefix.
    Add(Bytes),
    /// The subscriber no longer wants messages with this prefix.
    Cancel(Bytes),
}

/// Splits the body of a command into name and content.
pub(super) fn split(mut body: Bytes) -> Result<(Bytes, Bytes), ProtocolError> {
    let length = body.try_get_u8().map_err(|_empty| ProtocolError::MalformedCommand)?.into();
    if body.len() < length {
        return Err(ProtocolError::MalformedCommand);
    }
    let content = body.split_off(length);
    Ok((body, content))
}

impl Command {
    pub(super) fn parse(body: Bytes) -> Result<Self, ProtocolError> {
        let (name, mut content) = split(body)?;
        Ok(match &*name {
            b"X-SCL-ACK" => {
                let taken = number(&mut content)?;
                let received = if content.is_empty() { taken } else { number(&mut content)? };
                Self::Acknowledged { taken, received }
            }
            b"X-SCL-BEHIND" => Self::Behind,
            b"X-SCL-CATCH-UP" => Self::CatchUp(number(&mut content)?),
            b"X-SCL-CAUGHT-UP" => Self::CaughtUp(number(&mut content)?),
            b"X-SCL-FINISH" => Self::Finish,
            b"X-SCL-FINISHED" => Self::Finished,
            b"X-SCL-FLUSH" => Self::Flush,
            b"X-SCL-REFUSED" => Self::Refused(number(&mut content)?),
            b"X-SCL-LATCHED" => Self::Latched(number(&mut content)?),
            b"X-SCL-SENT" => Self::Sent(number(&mut content)?),
            b"X-SCL-RESUME" => Self::Resume(Resumed { end: number(&mut content)?, taken: number(&mut content)? }),
            b"X-SCL-SHM-OPEN" => Self::ShmOpen,
            b"X-SCL-SAMPLE" => Self::Sample { sequence: number(&mut content)?, length: number(&mut content)? },
            b"SUBSCRIBE" => Self::Subscription(Subscription::Add(content)),
            b"CANCEL" => Self::Subscription(Subscription::Cancel(content)),
            b"PING" => {
                // The first two bytes are the TTL, which is ignored.
                content.advance(content.len().min(2));
                content.truncate(CONTEXT);
                Self::Ping(content)
            }
            b"PONG" => Self::Pong,
            b"ERROR" => Self::Error(error_text(&content)),
            _ => Self::Unknown,
        })
    }
}

/// Reads the reason of an ERROR, which follows its length.
pub(super) fn error_text(content: &[u8]) -> String {
    let reason = content.get(1..).unwrap_or_default();
    let shown = &reason[..reason.len().min(255)];
    shown.escape_ascii().to_string()
}

/// Returns the subscription in a message, which is how ZMTP 3.0 sends it.
pub(in crate::transport::zeromq) fn subscription(mut body: Bytes) -> Option<Subscription> {
    match body.try_get_u8() {
        Ok(1) => Some(Subscription::Add(body)),
        Ok(0) => Some(Subscription::Cancel(body)),
        _ => None,
    }
}

/// The answer to a heartbeat.
pub(in crate::transport::zeromq) fn pong(context: &[u8]) -> Vec<u8> {
    [Header::new(COMMAND, 5 + context.len()).as_bytes(), b"\x04PONG", context].concat()
}

/// From a receiving end: the number of messages taken so far, and of those among them that do not wait any more.
pub(in crate::transport::zeromq) fn acknowledgement(taken: u64, received: u64) -> [u8; 28] {
    numbered_twice(b"\x09X-SCL-ACK", taken, received)
}

/// From a receiving end: report when no newer message waits.
pub(in crate::transport::zeromq) fn catch_up(number: u64) -> [u8; 25] {
    numbered(b"\x0eX-SCL-CATCH-UP", number)
}

/// From a sending end: no newer message waits.
pub(in crate::transport::zeromq) fn caught_up(number: u64) -> [u8; 26] {
    numbered(b"\x0fX-SCL-CAUGHT-UP", number)
}

/// From a replying end: the request of this number is not answered.
pub(in crate::transport::zeromq) fn refused(number: u64) -> [u8; 24] {
    numbered(b"\x0dX-SCL-REFUSED", number)
}

/// From a sending end: the next message was published `age_ns` nanoseconds ago, before the peer joined.
pub(in crate::transport::zeromq) fn latched(age_ns: u64) -> [u8; 24] {
    numbered(b"\x0dX-SCL-LATCHED", age_ns)
}

/// From a sending end: the next message was sent at `stamp`, in nanoseconds of `CLOCK_MONOTONIC`.
pub(in crate::transport::zeromq) fn sent(stamp: u64) -> [u8; 21] {
    numbered(b"\x0aX-SCL-SENT", stamp)
}

/// From a subscribing end, before it subscribes: which end it is, and what it has taken before.
pub(in crate::transport::zeromq) fn resume(Resumed { end, taken }: Resumed) -> [u8; 31] {
    numbered_twice(b"\x0cX-SCL-RESUME", end, taken)
}

/// From a sending end: a message of `length` bytes is in shared memory, as sample number `sequence`.
#[cfg(feature = "shm")]
pub(in crate::transport::zeromq) fn sample(sequence: u64, length: u64) -> [u8; 31] {
    numbered_twice(b"\x0cX-SCL-SAMPLE", sequence, length)
}

/// A command with two numbers.
fn numbered_twice<const LENGTH: usize>(name: &[u8], first: u64, second: u64) -> [u8; LENGTH] {
    let mut command = numbered(name, first);
    command[LENGTH - 8..].copy_from_slice(&second.to_be_bytes());
    command
}

/// A command with a number. Its length is known, so it needs no allocation.
fn numbered<const LENGTH: usize>(name: &[u8], number: u64) -> [u8; LENGTH] {
    let mut command = [0; LENGTH];
    command[..2].copy_from_slice(&[COMMAND, (LENGTH - 2) as u8]);
    command[2..2 + name.len()].copy_from_slice(name);
    command[2 + name.len()..][..8].copy_from_slice(&number.to_be_bytes());
    command
}

/// Takes a number from the front. What is left after the last number belongs to a later version and is ignored.
fn number(content: &mut Bytes) -> Result<u64, ProtocolError> {
    content.try_get_u64().map_err(|_too_short| ProtocolError::MalformedCommand)
}
