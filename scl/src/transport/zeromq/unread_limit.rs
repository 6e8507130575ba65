//! How much may wait for a requester or replier that does not read; beyond that it is disconnected.

use super::session::Session;

const BYTES: usize = 1 << 20;
const PIECES: usize = 64;
/// The pieces in which a message waits: its envelope, the header of its last frame, and its body.
const PIECES_OF_A_MESSAGE: usize = 3;

#[derive(Debug, Clone, Copy)]
pub(super) struct UnreadLimit {
    /// Messages for which there is room however long they are.
    messages: usize,
}

impl UnreadLimit {
    /// The limit between ends with so many requests in flight, if more than one.
    pub(super) fn of(in_flight: Option<usize>) -> Self {
        Self { messages: in_flight.unwrap_or(0) }
    }

    pub(super) fn is_reached(self, session: &Session) -> bool {
        let pieces = session.unwritten_pieces();
        let has_room = pieces < self.messages.saturating_mul(PIECES_OF_A_MESSAGE);
        !has_room && (pieces >= PIECES || session.unwritten_bytes() >= BYTES)
    }
}
