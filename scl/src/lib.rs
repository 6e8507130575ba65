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
pub use scl_macros::main;

/// Turns a topology file into one struct for each of its components, with a field for each gate.
///
/// ```text
/// scl::topology!("topology.yaml");
/// scl::topology!("topology.yaml", only = [sensor, controller]);
/// scl::topology!("topology.yaml", max_size = "8MiB");
/// ```
///
/// The file is looked for beside the calling source file, then in the package root, then in the workspace root. What is
/// wrong with it becomes compile errors, all at once. With `schemas:` in the file, each protobuf package becomes a module
/// with its messages.
#[macro_export]
macro_rules! topology {
    ($($input:tt)*) => {
        $crate::private::__topology! { $crate, $($input)* }
    };
}
