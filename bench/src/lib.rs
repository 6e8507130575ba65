//! Benchmarks of SCL beside raw sockets and other libraries, interleaved in one run: absolute times drift, ratios hold.
//!
//! Each benchmark is a function that takes its options and returns a [`Report`], which prints as text or JSON. Its
//! worker processes are the calling program itself, started with [`WORKER_COMMAND`] as the first argument; the program
//! passes the remaining arguments to [`run_worker`].
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod clock;
mod codecs;
mod components;
mod cores;
mod delay;
mod durations;
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
mod link;
mod message;
mod message_size;
mod one_way;
mod rate;
mod raw;
mod receiver;
mod report;
mod restart;
mod roles;
mod roundtrip;
mod runtime;
mod scratch;
mod sender;
mod transport;
mod unix;
mod variant;
mod worker;
#[cfg(feature = "gateway")]
mod zenoh_peer;

pub use codecs::{CodecsOptions, measure_codecs};
pub use cores::Cores;
pub use delay::{DelayOptions, measure_delay};
pub use fanout::{FanoutOptions, measure_fanout};
pub use fresh::{FreshOptions, measure_fresh};
pub use gateway_growth::{GatewayGrowthOptions, measure_gateway_growth};
pub use rate::{RateOptions, measure_rate};
pub use report::Report;
pub use restart::{RestartOptions, measure_restart};
pub use roles::run_worker;
pub use roundtrip::{RoundtripOptions, measure_roundtrip};
pub use scl::{Error, Result};
pub use transport::Transport;
pub use worker::WORKER_COMMAND;
