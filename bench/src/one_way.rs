//! Messages from one process to another, in one direction: what the scenarios `rate` and `delay` are made of.
//!
//! Each message starts with the time at which it was sent. The receiver answers each batch with a line: how long it took
//! from its first message to its last, and how long each message was under way, in nanoseconds.

mod components;
mod receiver;
mod sender;

pub(crate) use receiver::play_receiver;

use crate::processes::OtherProcess;
use crate::report::Others;
use scl::bytes::{BufMut, Bytes, BytesMut};
use scl::time::interval;
use sender::Sender;
use std::time::Duration;
use tokio::runtime::Runtime;

/// The shortest message: its time.
pub(crate) const SHORTEST: usize = 8;

/// A way from one process to another; `word` names it between them.
#[derive(Debug, PartialEq)]
pub(crate) struct Way {
    pub(crate) word: &'static str,
    pub(crate) name: &'static str,
    pub(crate) beside: Others,
}

pub(crate) const SCL_PUBLISH: Way =
    way("scl-publish", "SCL pub/sub", &[("zeromq", "zeromq XPUB/SUB"), ("libzmq", "libzmq XPUB/SUB")]);
pub(crate) const RAW_PUBLISH: Way = way("raw-publish", "zeromq XPUB/SUB", &[("libzmq", "libzmq XPUB/SUB")]);
#[cfg(feature = "libzmq")]
pub(crate) const LIBZMQ_PUBLISH: Way = way("libzmq-publish", "libzmq XPUB/SUB", &[("zeromq", "zeromq XPUB/SUB")]);
pub(crate) const SCL_PUSH: Way =
    way("scl-push", "SCL push/pull", &[("zeromq", "zeromq PUSH/PULL"), ("libzmq", "libzmq PUSH/PULL")]);
pub(crate) const RAW_PUSH: Way = way("raw-push", "zeromq PUSH/PULL", &[("libzmq", "libzmq PUSH/PULL")]);
#[cfg(feature = "libzmq")]
pub(crate) const LIBZMQ_PUSH: Way = way("libzmq-push", "libzmq PUSH/PULL", &[("zeromq", "zeromq PUSH/PULL")]);
pub(crate) const UNIX: Way = way("unix", "Unix socket, tokio", &[]);

const fn way(word: &'static str, name: &'static str, beside: Others) -> Way {
    Way { word, name, beside }
}

/// What a receiver says of one batch, in nanoseconds.
#[derive(Debug, PartialEq)]
pub(crate) struct Received {
    /// From the first message sent to the last received.
    pub(crate) span: u64,
    /// From sending to receiving, one a message.
    pub(crate) delays: Vec<u64>,
}

/// A way in use, with the process that receives.
pub(crate) struct Lane {
    sender: Sender,
    receiver: OtherProcess,
    bytes: usize,
    batch: usize,
}

impl Lane {
    /// Starts the receiver for batches of so many messages of so many bytes, at least [`SHORTEST`].
    pub(crate) fn open(runtime: &Runtime, way: &Way, folder: &str, bytes: usize, batch: usize) -> scl::Result<Self> {
        let words = ["one-way", way.word, folder, &bytes.to_string(), &batch.to_string()];
        let (sender, receiver) = runtime.block_on(Sender::start(way.word, folder, &words))?;
        Ok(Self { sender, receiver, bytes, batch })
    }

    /// Sends one batch as fast as it goes.
    pub(crate) async fn send_batch(&mut self) -> scl::Result<()> {
        for _ in 0..self.batch {
            self.sender.send(message(self.bytes)).await?;
        }
        Ok(())
    }

    /// Sends one batch, a message each period.
    pub(crate) async fn send_steadily(&mut self, period: Duration) -> scl::Result<()> {
        let mut tick = interval(period)?;
        for _ in 0..self.batch {
            tick.tick().await;
            self.sender.send(message(self.bytes)).await?;
        }
        Ok(())
    }

    /// Waits until the batch has arrived as a whole.
    pub(crate) async fn received(&mut self) -> scl::Result<Received> {
        Received::parse(&self.receiver.line().await?)
    }
}

impl Received {
    pub(crate) fn parse(line: &str) -> scl::Result<Self> {
        let mut numbers = line.split_ascii_whitespace().map(str::parse);
        let span = numbers.next().unwrap_or(Ok(0))?;
        Ok(Self { span, delays: numbers.collect::<Result<_, _>>()? })
    }

    pub(crate) fn to_line(&self) -> String {
        let delays = self.delays.iter().map(u64::to_string);
        std::iter::once(self.span.to_string()).chain(delays).collect::<Vec<_>>().join(" ")
    }
}

/// A message that carries the time.
fn message(bytes: usize) -> Bytes {
    let mut message = BytesMut::zeroed(bytes.max(SHORTEST));
    (&mut message[..SHORTEST]).put_u64(crate::clock::now());
    message.freeze()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_receiver_says_is_read_back() {
        for received in [Received { span: 7, delays: vec![] }, Received { span: 7, delays: vec![1, 2] }] {
            assert_eq!(Received::parse(&received.to_line()).unwrap(), received);
        }
        assert!(Received::parse("7 x").is_err());
    }

    #[test]
    fn a_message_is_as_long_as_wanted_and_carries_the_time() {
        let before = crate::clock::now();
        let message = message(20);
        assert_eq!(message.len(), 20);
        let sent = u64::from_be_bytes(message[..SHORTEST].try_into().unwrap());
        assert!((before..=crate::clock::now()).contains(&sent));
    }
}
