//! What every handle needs of the wire.

use super::command::Commands;
use super::presence::Presence;

/// The way to the thread, the table of who is there, and this gateway's own number.
#[derive(Debug, Clone)]
pub(super) struct Link {
    pub(super) commands: Commands,
    pub(super) presence: Presence,
    pub(super) instance: String,
}
