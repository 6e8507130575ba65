//! How the cost of a gateway grows with its connections and with the hosts it is connected to.

#[cfg(feature = "gateway")]
mod far_host;
#[cfg(feature = "gateway")]
mod near_host;
#[cfg(feature = "gateway")]
mod system;

#[cfg(feature = "gateway")]
pub(crate) use far_host::run_far_host;

use crate::limits::{MESSAGES, parse_seconds, within};
use crate::report::Report;
use crate::transport::Transport;
use clap::Args;
use std::time::Duration;

/// Measure how the cost of a gateway grows with its connections: time until all are matched, memory, processor
/// time, round trip.
///
/// Needs the program `scl-gateway` beside this one or in `PATH`, and the feature `gateway` of this program.
#[derive(Debug, Args)]
pub(crate) struct GatewayGrowthOptions {
    /// The numbers of connections, one line each.
    #[arg(long, value_delimiter = ',', default_values_t = [1, 10, 50, 100, 200, 500], value_parser = within(1..=5000))]
    pub(crate) connections: Vec<usize>,
    /// The number of other hosts, each with a gateway, between which the connections are divided.
    #[arg(long, default_value_t = 1, value_parser = within(1..=100))]
    pub(crate) hosts: usize,
    /// How long each line is observed while idle, and as long under load.
    #[arg(long, default_value = "10", value_parser = parse_seconds)]
    pub(crate) seconds: Duration,
    /// The number of round trips of each line.
    #[arg(long, default_value_t = 1000, value_parser = within(MESSAGES))]
    pub(crate) messages: usize,
}

pub(crate) fn measure_gateway_growth(options: &GatewayGrowthOptions) -> scl::Result<Report> {
    Transport::Gateway.check_is_built_in()?;
    #[cfg(feature = "gateway")]
    return near_host::measure(options);
    #[cfg(not(feature = "gateway"))]
    Err(scl::Error::message(format!("{options:?} cannot be measured")))
}
