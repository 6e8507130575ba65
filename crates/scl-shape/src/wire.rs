//! The wire format of protobuf.

/// Levels of nesting after which every decoder gives up.
pub(crate) const LEVELS: usize = 128;

// The wire types that callers treat specially; of the others they need only the length.
pub(crate) const LENGTH_DELIMITED: u32 = 2;
pub(crate) const GROUP_START: u32 = 3;
pub(crate) const GROUP_END: u32 = 4;

/// Reads a key, and advances `at` past it. Returns the number of the field and its wire type.
pub(crate) fn key(bytes: &[u8], at: &mut usize) -> Option<(u32, u32)> {
    // Decoders reject keys of more than 32 bits, except protobuf-c, which ignores the excess bits.
    let key = varint(bytes, at)? as u32;
    Some((key >> 3, key & 7))
}

/// Advances `at` to the content after a key, which is not the end of a group, and returns the content's length: 0 for
/// the start of a group, and for a varint, which is skipped. `None` if the content is not complete.
pub(crate) fn content_length(wire_type: u32, bytes: &[u8], at: &mut usize) -> Option<usize> {
    let length = match wire_type {
        0 => varint(bytes, at).map(|_number| 0)?,
        1 => 8,
        LENGTH_DELIMITED => varint(bytes, at)?,
        GROUP_START => 0,
        5 => 4,
        _ => return None,
    };
    usize::try_from(length).ok().filter(|length| *length <= bytes.len() - *at)
}

/// Reads a varint, and advances `at` past it; `None` if it is not complete or longer than ten bytes.
fn varint(bytes: &[u8], at: &mut usize) -> Option<u64> {
    let mut number = 0;
    for shift in (0..64).step_by(7) {
        let byte = *bytes.get(*at)?;
        *at += 1;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return Some(number);
        }
    }
    None
}
