//! Recording, replay and comparison of systems, in MCAP files.
//!
//! [`mod@format`] defines what a recording contains. [`record`] writes recordings, [`recording`] reads them.
#![cfg_attr(test, allow(clippy::unwrap_used))]

pub mod compare;
pub mod format;
mod parse;
pub mod progress;
pub mod record;
pub mod recording;
pub mod recover;
pub mod replay;
#[cfg(any(test, feature = "testing"))]
#[doc(hidden)]
pub mod testing;
