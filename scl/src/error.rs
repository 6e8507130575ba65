//! What can go wrong, one type an operation. Every text names the component, the gate and the peer, and says what to do.

use crate::codec::{DecodeError, EncodeError};
use crate::gate::{GateName, Peers};
use crate::transport::TransportError;
use std::fmt;
use std::time::Duration;
use thiserror::Error;

/// The result of a program's main function: any error, with its causes.
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Any error, with its causes; every error type turns into it with `?`.
///
/// It implements no `std::error::Error` itself, because that would forbid the conversion from every error.
pub struct Error(Box<dyn std::error::Error + Send + Sync>);

impl Error {
    /// An error that is only a text.
    pub fn message(text: impl Into<String>) -> Self {
        Self(text.into().into())
    }

    /// The error inside.
    pub fn inner(&self) -> &(dyn std::error::Error + Send + Sync + 'static) {
        &*self.0
    }

    /// Whether it says that the program was told to stop, which is no failure.
    pub fn is_stop(&self) -> bool {
        let mut cause: Option<&(dyn std::error::Error + 'static)> = Some(&*self.0);
        while let Some(error) = cause {
            if matches!(error.downcast_ref(), Some(BlockingError::Stopped)) {
                return true;
            }
            cause = error.source();
        }
        false
    }
}

impl<E: std::error::Error + Send + Sync + 'static> From<E> for Error {
    fn from(error: E) -> Self {
        Self(Box::new(error))
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

/// The error and its causes, one a line.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0)?;
        let mut cause = self.0.source();
        while let Some(error) = cause {
            write!(f, "\n  caused by: {error}")?;
            cause = error.source();
        }
        Ok(())
    }
}

/// A component could not be opened.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum OpenError {
    /// The runtime folder, the component's lock or its announcement.
    #[error("component `{component}` cannot be opened: {source}")]
    Place {
        /// The component.
        component: &'static str,
        /// What is wrong there, and what to do.
        source: crate::place::PlaceError,
    },
    /// A gate's connection could not be set up.
    #[error("gate `{gate}` cannot be opened: {source}")]
    Gate {
        /// The gate.
        gate: GateName,
        /// Why.
        source: TransportError,
    },
    /// The operating system gave no timer for a gate's `timeout`.
    #[error("gate `{gate}` cannot be opened: no timer for its timeout: {source}")]
    Timer {
        /// The gate.
        gate: GateName,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// An asynchronous open outside of a tokio runtime.
    #[error(
        "component `{component}` is opened outside of a tokio runtime; \
         write `#[scl::main]` on `async fn main`, or use `open_blocking`"
    )]
    NoRuntime {
        /// The component.
        component: &'static str,
    },
    /// The operating system gave no runtime to a program without async.
    #[error("component `{component}` cannot start its runtime: {source}")]
    Runtime {
        /// The component.
        component: &'static str,
        /// What the operating system said.
        source: std::io::Error,
    },
    /// The `scl` crate was built without any transport.
    #[error(
        "component `{component}` has no transport: switch on the feature `zeromq` of the crate `scl`, or choose one with `OpenOptions::transport`"
    )]
    NoTransport {
        /// The component.
        component: &'static str,
    },
    /// An environment variable that has no such value.
    #[error("`{variable}={value}` is not understood; write one of: {expected}")]
    Environment {
        /// The variable.
        variable: &'static str,
        /// Its value.
        value: String,
        /// What it may be.
        expected: &'static str,
    },
}

/// A call from a program without async could not wait.
#[derive(Debug, Error, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum BlockingError {
    /// Called from async code, which it would bring to a halt.
    #[error("a blocking call inside async code would stop all of it; use the async call with `.await`")]
    InsideAsync,
    /// SIGTERM or SIGINT came while `#[scl::main]` ran the program.
    #[error("the program was told to stop")]
    Stopped,
}

/// A message was not sent.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SendError {
    /// The codec cannot express the message.
    #[error("gate `{gate}` cannot send this message: {source}")]
    Encode {
        /// The gate.
        gate: GateName,
        /// Why.
        source: EncodeError,
    },
    /// The blocking call could not wait.
    #[error("gate `{gate}` did not send: {source}")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// Why.
        source: BlockingError,
    },
}

/// A message was not sent by a call that never waits.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TrySendError {
    /// A peer with `when_full: wait` would make this gate wait.
    #[error("gate `{gate}` would have to wait: the queue of {peers} is full; send later, or use `send`")]
    Full {
        /// The gate.
        gate: GateName,
        /// Its peers.
        peers: Peers,
    },
    /// What `send` can run into as well.
    #[error(transparent)]
    Send(#[from] SendError),
}

/// A message was not received.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecvError {
    /// A message came that the codec cannot read. The next call goes on with the next message.
    #[error("gate `{gate}` received something from {peers} that is no message: {source}")]
    Decode {
        /// The gate.
        gate: GateName,
        /// Who sent it, or, at a gate that listens for several, who may have.
        peers: Peers,
        /// Why it cannot be read; it names the codec.
        source: DecodeError,
    },
    /// The blocking call could not wait.
    #[error("gate `{gate}` did not receive: {source}")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// Why.
        source: BlockingError,
    },
}

/// A message was not received in time.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum RecvTimeoutError {
    /// Nothing came.
    #[error("gate `{gate}` received nothing from {peers} within {waited:?}")]
    Timeout {
        /// The gate.
        gate: GateName,
        /// Its peers.
        peers: Peers,
        /// How long it waited.
        waited: Duration,
    },
    /// What every receiving call can run into.
    #[error(transparent)]
    Recv(#[from] RecvError),
}

/// A request got no answer.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CallError {
    /// The codec cannot express the request.
    #[error("gate `{gate}` cannot send this request: {source}")]
    Encode {
        /// The gate.
        gate: GateName,
        /// Why.
        source: EncodeError,
    },
    /// No answer came in time. A late one is discarded.
    #[error("gate `{gate}` got no answer from {peers} within {waited:?}{}", if *connected { "" } else { ": it is not running" })]
    Timeout {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
        /// How long it waited.
        waited: Duration,
        /// Whether the replier was connected at the end.
        connected: bool,
    },
    /// The replier went away after it was asked; whether it acted on the request is not known.
    #[error("gate `{gate}` got no answer: {peers} went away after it was asked; the next call waits for its return")]
    PeerLost {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
    },
    /// An answer came that the codec cannot read.
    #[error("gate `{gate}` received something from {peers} that is no answer: {source}")]
    Decode {
        /// The gate.
        gate: GateName,
        /// The replier.
        peers: Peers,
        /// Why it cannot be read; it names the codec.
        source: DecodeError,
    },
    /// The blocking call could not wait.
    #[error("gate `{gate}` did not ask: {source}")]
    Blocking {
        /// The gate.
        gate: GateName,
        /// Why.
        source: BlockingError,
    },
}

/// An answer was not sent.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ReplyError {
    /// The codec cannot express the answer.
    #[error("gate `{gate}` cannot send this answer: {source}")]
    Encode {
        /// The gate.
        gate: GateName,
        /// Why.
        source: EncodeError,
    },
    /// Whoever asked is not connected any more.
    #[error("gate `{gate}` cannot answer: the requester is gone")]
    RequesterGone {
        /// The gate.
        gate: GateName,
    },
}

/// Not all required peers were there in time.
#[derive(Debug, Error)]
#[error("component `{component}` waited {waited:?} in vain for {}", Missing(missing))]
pub struct NotReady {
    /// The component that waited.
    pub component: &'static str,
    /// The gates that wait, with the peers they wait for: `("setpoint", "controller.actuator")`.
    pub missing: Vec<(&'static str, String)>,
    /// How long it waited.
    pub waited: Duration,
}

struct Missing<'a>(&'a [(&'static str, String)]);

impl fmt::Display for Missing<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (gate, peer)) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { ", " };
            write!(f, "{separator}`{peer}` (at gate `{gate}`)")?;
        }
        Ok(())
    }
}

/// A component was closed before its peers had taken everything.
#[derive(Debug, Error)]
#[error("component `{component}` was closed with {waiting} messages that its peers did not take within {waited:?}")]
pub struct NotFlushed {
    /// The component.
    pub component: &'static str,
    /// How many messages were given up.
    pub waiting: usize,
    /// How long it waited.
    pub waited: Duration,
}
