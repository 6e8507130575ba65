//! What SCL serves of running systems: to a browser, the live picture of `scl watch` with the components, what flows
//! between their gates, and what is wrong now; to Prometheus, the figures of `scl metrics`. Nothing is read while
//! nobody asks, and components notice nothing.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod access;
mod actions;
mod board;
mod details;
mod happenings;
mod http;
mod live;
mod log;
mod metrics;
mod picture;
mod plans;
mod problems;
mod replay;
mod server;
mod shown;
mod site;
mod stream;

pub use metrics::{DASHBOARD, MetricsServer, metrics};
pub use server::{Server, Source};

use picture::VARIANTS;
use scl_observe::System;
use scl_plan::SystemPlan;
use site::{Look, Site};
use std::thread::sleep;
use std::time::Duration;

/// The time over which the rates of a still picture are measured: components write their figures twice in it.
const MEASURED: Duration = Duration::from_secs(1);

/// Draws a system as it is now, as SVG. Blocks the thread for a second.
#[must_use]
pub fn picture(system: &System, file: Option<SystemPlan>) -> String {
    let site = Site::new(system.clone(), file);
    let mut look = Look::new(&site);
    look.look();
    sleep(MEASURED);
    look.picture(VARIANTS[0])
}
