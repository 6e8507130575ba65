//! What runs in a system: components, gates, figures, and the messages at their taps.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod bandwidth;
mod delay;
mod distribution;
mod rate;

pub use bandwidth::{BandwidthFigures, BandwidthMeter};
pub use delay::{DelayFigures, DelayMeter};
pub use distribution::Spread;
pub use rate::{RateFigures, RateMeter};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ObservedKind { Message, Request, Reply }
