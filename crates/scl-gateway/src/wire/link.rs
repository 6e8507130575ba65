//! What every handle needs of the wire.

use super::command::Commands;
use super::presence::Presence;

/// The channel to the wire thread, the table of connected gateways, and the number of this gateway's run.
#[derive(Debug, Clone)]
pub(super) struct Link {
    pub(super) commands: Commands,
    pub(super) presence: Presence,
    pub(super) instance: String,
}
