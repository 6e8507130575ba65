//! How the cost of a gateway grows with its connections and with the hosts it is connected to.

#[cfg(feature = "gateway")]
mod far_host;
#[cfg(feature = "gateway")]
mod near_host;
#[cfg(feature = "gateway")]
mod system;

#[cfg(feature = "gateway")]
pub(crate) use far_host::run_far_host;

use crate::report::Report;
use crate::transport::Transport;
use std::ops::RangeInclusive;
use std::time::Duration;

/// Options of [`measure_gateway_growth`].
#[derive(Debug, Clone)]
pub struct GatewayGrowthOptions {
    /// The numbers of connections, one line each; within [`GatewayGrowthOptions::CONNECTIONS`].
    pub connections: Vec<usize>,
    /// The number of other hosts, each with a gateway, between which the connections are divided; within
    /// [`GatewayGrowthOptions::HOSTS`].
    pub hosts: usize,
    /// How long each line is observed while idle, and as long under load.
    pub time: Duration,
    /// The number of round trips of each line.
    pub messages: usize,
}

impl GatewayGrowthOptions {
    /// The supported numbers of connections.
    pub const CONNECTIONS: RangeInclusive<usize> = 1..=5000;

    /// The supported numbers of other hosts.
    pub const HOSTS: RangeInclusive<usize> = 1..=100;
}

/// Measures memory, processor time, time to match and round trip of a gateway with more and more connections.
///
/// # Errors
///
/// This program was built without the feature `gateway`, `scl-gateway` is not found, the folder for temporary files
/// cannot be used, or a connection fails.
pub fn measure_gateway_growth(options: &GatewayGrowthOptions) -> scl::Result<Report> {
    Transport::Gateway.check_is_built_in()?;
    #[cfg(feature = "gateway")]
    return near_host::measure(options);
    #[cfg(not(feature = "gateway"))]
    Err(scl::Error::message(format!("{options:?} cannot be measured")))
}
