//! ZMTP 3.0 (RFC 23) without I/O: encoding and decoding both directions of a connection, with SCL's additions.
//!
//! Later versions of the protocol fall back to 3.0 towards a peer that announces 3.0. `docs/zeromq.md` describes the
//! additions exactly.

mod command;
mod decoder;
mod error;
mod frame;
mod greeting;
mod ready;
mod socket_type;
#[cfg(test)]
mod tests;

#[cfg(feature = "shm")]
pub(super) use command::sample;
pub(super) use command::{
    BEHIND, Command, FINISH, FINISHED, FLUSH, SHM_OPEN, SUBSCRIBE_ALL, SUBSCRIBE_ALL_AND_PING, Subscription,
    acknowledgement, catch_up, caught_up, latched, pong, refused, resume, sent,
};
pub(super) use decoder::{Decoder, Item, Message};
pub(super) use error::ProtocolError;
pub(super) use frame::{Header, MORE, bodies};
pub(super) use ready::{ConnectionId, PeerReady, SclReady, ShmReady, hello};
pub(super) use socket_type::SocketType;

/// Decodes everything that a peer sends to a socket of a type, in pieces, and returns how many items it understood.
///
/// For fuzzing.
///
/// # Errors
/// The text of the protocol error.
///
/// # Panics
/// If the decoder holds more memory than what has arrived justifies.
#[doc(hidden)]
pub fn decode_for_fuzzing<'p>(
    socket: &str,
    max_size: usize,
    pieces: impl IntoIterator<Item = &'p [u8]>,
) -> Result<usize, String> {
    let socket = SocketType::of(socket).unwrap_or(SocketType::XPub);
    let mut decoder = Decoder::new(socket, max_size);
    let (mut items, mut arrived) = (0, 0);
    for piece in pieces {
        decoder.room().extend_from_slice(piece);
        arrived += piece.len();
        while decoder.next_item().map_err(|error| error.to_string())?.is_some() {
            items += 1;
        }
        let reserved = decoder.room().capacity();
        assert!(reserved <= 4 * arrived + (4 << 20), "{reserved} bytes are reserved, {arrived} have arrived");
    }
    Ok(items)
}
