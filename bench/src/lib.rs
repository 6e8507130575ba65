//! Benchmarks of SCL beside raw sockets and other libraries, interleaved in one run: absolute times drift, ratios hold.
//!
//! [`BenchArguments`] are the arguments of `scl bench`. Worker processes are the calling program itself, started with
//! [`WORKER_COMMAND`] as the first argument; the program passes the remaining arguments to [`run_worker`].
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod arguments;
mod clock;
mod codecs;
mod components;
mod cores;
mod delay;
mod durations;
mod ends;
mod engines;
mod fanout;
#[cfg(feature = "gateway")]
mod footprint;
mod fresh;
#[cfg(feature = "gateway")]
mod gateway;
mod gateway_growth;
#[cfg(feature = "shm")]
mod iceoryx;
#[cfg(feature = "libzmq")]
mod libzmq;
mod limits;
mod link;
mod message;
mod one_way;
mod rate;
mod raw;
mod report;
mod restart;
mod roles;
mod roundtrip;
mod runtime;
mod scratch;
mod transport;
mod unix;
mod variant;
mod worker;
#[cfg(feature = "gateway")]
mod zenoh_peer;

pub use arguments::BenchArguments;
pub use roles::run_worker;
pub use scl::{Error, Result};
pub use worker::WORKER_COMMAND;
