//! Typed components and gates, wired by one checked YAML file, over ZeroMQ.
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod codec;
mod component;
mod error;
mod gate;
pub mod place;
#[doc(hidden)]
pub mod private;
pub mod spec;
mod sync;
pub mod time;
pub mod transport;

pub use bytes;
pub use component::{Component, OpenOptions};
pub use error::{
    BlockingError, CallError, Error, NotFlushed, NotReady, OpenError, RecvError, RecvTimeoutError, ReplyError, Result,
    SendError, TrySendError,
};
pub use gate::{AnyGate, GateName, GateStats, Peers, Pub, Pull, Push, Rep, Req, Request, Sub};
