//! Gates of different kinds behind one type.

use super::message::Message;
use bytes::Bytes;
use futures_core::Stream;
use futures_sink::Sink;
use scl::{GateStats, PeerStats, Pub, Pull, Push, Sub};
use std::pin::Pin;
use std::task::{Context, Poll};

/// The gate that sends.
pub(super) enum Sender {
    Pub(Pub<Bytes>),
    Push(Push<Bytes>),
}

impl Sender {
    pub(super) async fn send(&mut self, message: Message) -> Result<(), String> {
        let sent = match self {
            Self::Pub(gate) => gate.send(&message.frame()).await,
            Self::Push(gate) => gate.send(&message.frame()).await,
        };
        sent.map_err(|error| error.to_string())
    }

    pub(super) fn try_send(&mut self, message: Message) -> Result<(), String> {
        let sent = match self {
            Self::Pub(gate) => gate.try_send(&message.frame()),
            Self::Push(gate) => gate.try_send(&message.frame()),
        };
        sent.map_err(|error| error.to_string())
    }

    /// Returns true if there is room for a message. If not, wakes the task when there is.
    pub(super) fn poll_room(&mut self, cx: &mut Context<'_>) -> bool {
        match self {
            Self::Pub(gate) => Pin::new(gate).poll_ready(cx).is_ready(),
            Self::Push(gate) => Pin::new(gate).poll_ready(cx).is_ready(),
        }
    }

    /// Returns true if everything is handed over.
    pub(super) fn poll_flush(&mut self, cx: &mut Context<'_>) -> bool {
        match self {
            Self::Pub(gate) => Pin::new(gate).poll_flush(cx).is_ready(),
            Self::Push(gate) => Pin::new(gate).poll_flush(cx).is_ready(),
        }
    }

    pub(super) fn stats(&self) -> (GateStats, Vec<PeerStats>) {
        match self {
            Self::Pub(gate) => (gate.stats(), gate.peer_stats()),
            Self::Push(gate) => (gate.stats(), gate.peer_stats()),
        }
    }
}

/// A gate that receives.
pub(super) enum Receiver {
    Sub(Sub<Bytes>),
    Pull(Pull<Bytes>),
}

impl Receiver {
    /// Returns the next message, if any. If not, wakes the task when there is one.
    pub(super) fn poll_recv(&mut self, cx: &mut Context<'_>) -> Result<Option<Message>, String> {
        let polled = match self {
            Self::Sub(gate) => Pin::new(gate).poll_next(cx),
            Self::Pull(gate) => Pin::new(gate).poll_next(cx),
        };
        match polled {
            Poll::Ready(Some(received)) => read(received.map(Some)),
            Poll::Ready(None) => Err("the stream of messages has ended".to_owned()),
            Poll::Pending => Ok(None),
        }
    }

    pub(super) fn try_recv(&mut self) -> Result<Option<Message>, String> {
        read(match self {
            Self::Sub(gate) => gate.try_recv(),
            Self::Pull(gate) => gate.try_recv(),
        })
    }

    pub(super) fn latest(&mut self) -> Result<Option<Message>, String> {
        read(match self {
            Self::Sub(gate) => gate.latest(),
            Self::Pull(gate) => gate.latest(),
        })
    }

    pub(super) fn stats(&self) -> GateStats {
        match self {
            Self::Sub(gate) => gate.stats(),
            Self::Pull(gate) => gate.stats(),
        }
    }
}

fn read<E: std::error::Error>(received: Result<Option<Bytes>, E>) -> Result<Option<Message>, String> {
    let frame = received.map_err(|error| error.to_string())?;
    frame.map(|frame| Message::read(&frame)).transpose()
}
