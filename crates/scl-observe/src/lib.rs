//! What runs in a system: components and gates as their programs announce them, their figures, and the messages at
//! their taps. Everything here only reads; no program is delayed, restarted or asked to cooperate.
//!
//! ```no_run
//! use scl_observe::{System, Taps, TapsEvent};
//!
//! # async fn example() -> Result<(), scl_terminal::Problem> {
//! let system = System::find(None)?; // the one that runs
//! let gate = system.gate("sensor.measurements")?;
//! let mut taps = Taps::open(&system, vec![gate]);
//! loop {
//!     if let TapsEvent::Event { gate, event } = taps.next().await {
//!         println!("{}: {event:?}", taps.gates()[gate].name());
//!     }
//! }
//! # }
//! ```
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod bandwidth;
mod commands;
mod component;
mod delay;
mod distribution;
mod doctor;
mod find;
mod folder_changes;
mod gate;
mod json;
mod lookup;
mod measure;
mod peer;
mod plan_of;
mod process;
mod rate;
mod runtime;
mod selection;
mod snapshot;
mod system;
mod taps;
mod throughput;
mod woken;

pub use bandwidth::{BandwidthFigures, BandwidthMeter};
pub use commands::Commands;
pub use component::{Activity, Component};
pub use delay::{DelayFigures, DelayMeter};
pub use distribution::{Distribution, Spread};
pub use doctor::{Finding, Severity, examine};
pub use gate::{ObservedGate, Tap};
pub use measure::{GateReport, Measurement, Meter, at_taps};
pub use peer::{Peer, connected_peers, peers};
pub use process::ProcessFigures;
pub use rate::{RateFigures, RateMeter};
pub use runtime::{StopSignals, block_on, watch_signal};
pub use scl_terminal::problem_of;
pub use selection::Selection;
pub use snapshot::{ComponentRow, ConnectionRow, GateRow, Snapshot, Watch};
pub use system::System;
pub use taps::{Taps, TapsEvent};
pub use throughput::{GateRate, message_count, rates};
