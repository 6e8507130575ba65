//! SCL measured beside the raw parts it is made of, interleaved in one run: absolute times drift, ratios hold.
//!
//! Each scenario is a function that takes its options and gives a [`Report`], which prints as text or JSON. The other
//! processes of a scenario are the calling program itself, started with [`OTHER_SIDE`] as its first argument; such a
//! program hands the remaining arguments to [`play_other_side`].
#![deny(missing_docs)]
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod clock;
mod codecs;
mod cores;
mod delay;
mod fanout;
mod histogram;
mod lengths;
#[cfg(feature = "libzmq")]
mod libzmq;
mod one_way;
mod open;
mod processes;
mod rate;
mod raw;
mod report;
mod roundtrip;

pub use codecs::{Codecs, measure_codecs};
pub use cores::Cores;
pub use delay::{Delay, measure_delay};
pub use fanout::{Fanout, measure_fanout};
pub use open::{Open, measure_open};
pub use processes::{OTHER_SIDE, play_other_side};
pub use rate::{Rate, measure_rate};
pub use report::Report;
pub use roundtrip::{Roundtrip, measure_roundtrip};
pub use scl::{Error, Result};

/// Says how often this process has allocated memory so far; from a counting allocator of the calling program.
pub type AllocationCount = fn() -> u64;
