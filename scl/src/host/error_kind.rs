//! Telling errors apart without their types.

use crate::error::{
    BlockingError, CallError, NotFlushed, NotReady, OpenError, RecvError, RecvTimeoutError, ReplyError, SendError,
    SendTimeoutError, TrySendError,
};
use crate::untyped::WaitError;
use std::error::Error;

/// The kind of an error, whatever its type: for languages that report errors as status codes or exception classes.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub enum ErrorKind<'e> {
    /// The call could not be made, or had to stop waiting.
    Blocking(BlockingError),
    /// The component could not be opened.
    Open(&'e OpenError),
    /// Not all required peers connected in time.
    NotReady,
    /// Not all peers took all messages in time.
    NotFlushed,
    /// The codec cannot express the message.
    Encode,
    /// The message is longer than a peer accepts.
    TooLong,
    /// The queue of a peer is full, and the call does not wait.
    Full,
    /// The queue of a peer was full until the time limit.
    SendTimeout,
    /// Nothing arrived in time.
    Timeout,
    /// The codec cannot read what arrived.
    Decode,
    /// The replier disconnected after the request was sent.
    PeerLost,
    /// The replier has refused the request.
    Refused,
    /// The requester has disconnected.
    RequesterGone,
    /// Anything else.
    Other,
}

/// Returns the kind of an error if it is one of these types.
macro_rules! kinds {
    ($error:ident: $($type:ident { $($case:pat => $kind:expr,)+ })+) => {
        $(if let Some(error) = $error.downcast_ref::<$type>() {
            return match error { $($case => $kind,)+ };
        })+
    };
}

impl<'e> ErrorKind<'e> {
    /// Returns the kind of an error of a component or of one of its gates.
    pub fn of(error: &'e (dyn Error + 'static)) -> Self {
        kinds! { error:
            BlockingError { source => Self::Blocking(*source), }
            OpenError { error => Self::Open(error), }
            NotReady { _ => Self::NotReady, }
            NotFlushed { _ => Self::NotFlushed, }
            SendError {
                SendError::Encode { .. } => Self::Encode,
                SendError::TooLong { .. } => Self::TooLong,
                SendError::Blocking { source, .. } => Self::Blocking(*source),
            }
            TrySendError {
                TrySendError::Full { .. } => Self::Full,
                TrySendError::Send(error) => Self::of(error),
            }
            SendTimeoutError {
                SendTimeoutError::Timeout { .. } => Self::SendTimeout,
                SendTimeoutError::Send(error) => Self::of(error),
            }
            RecvError {
                RecvError::Decode { .. } => Self::Decode,
                RecvError::NoViews { .. } | RecvError::NoDeadline { .. } | RecvError::Timer { .. } => Self::Other,
                RecvError::Blocking { source, .. } => Self::Blocking(*source),
            }
            RecvTimeoutError {
                RecvTimeoutError::Timeout { .. } => Self::Timeout,
                RecvTimeoutError::Recv(error) => Self::of(error),
            }
            WaitError {
                WaitError::Timeout { .. } => Self::Timeout,
                WaitError::Blocking { source, .. } => Self::Blocking(*source),
                WaitError::Recv(error) => Self::of(error),
            }
            CallError {
                CallError::Encode { .. } => Self::Encode,
                CallError::TooLong { .. } => Self::TooLong,
                CallError::Timeout { .. } => Self::Timeout,
                CallError::PeerLost { .. } => Self::PeerLost,
                CallError::Refused { .. } => Self::Refused,
                CallError::Decode { .. } => Self::Decode,
                CallError::Blocking { source, .. } => Self::Blocking(*source),
            }
            ReplyError {
                ReplyError::Encode { .. } => Self::Encode,
                ReplyError::TooLong { .. } => Self::TooLong,
                ReplyError::RequesterGone { .. } => Self::RequesterGone,
                ReplyError::Blocking { source, .. } => Self::Blocking(*source),
            }
        }
        Self::Other
    }
}
