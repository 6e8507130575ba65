//! The greeting: 64 bytes that both sides send first.

use super::ProtocolError;

pub(super) const LENGTH: usize = 64;
const MECHANISM: std::ops::Range<usize> = 12..32;

/// The greeting of version 3.0 with the mechanism NULL.
pub(super) fn greeting() -> [u8; LENGTH] {
    let mut greeting = [0; LENGTH];
    greeting[0] = 0xff;
    greeting[9] = 0x7f;
    greeting[10] = 3;
    greeting[MECHANISM][..4].copy_from_slice(b"NULL");
    greeting
}

/// Checks what has arrived of a greeting. Returns true if it is complete.
pub(super) fn check(arrived: &[u8]) -> Result<bool, ProtocolError> {
    // Reject early: a peer with a different greeting may never send the rest.
    let wrong = |place: usize, right: fn(u8) -> bool| arrived.get(place).is_some_and(|&byte| !right(byte));
    if wrong(0, |byte| byte == 0xff) || wrong(9, |byte| byte & 1 == 1) {
        return Err(ProtocolError::NotZmtp);
    }
    if wrong(10, |major| major >= 3) {
        return Err(ProtocolError::Version);
    }
    let Some(mechanism) = arrived.get(MECHANISM) else { return Ok(false) };
    if mechanism != &greeting()[MECHANISM] {
        return Err(ProtocolError::Mechanism);
    }
    Ok(arrived.len() >= LENGTH)
}
