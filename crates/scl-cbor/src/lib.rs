//! Converts CBOR of other encoders to the form that SCL's decoders read.
//!
//! Encoders of other languages may write 16-bit floats and tags anywhere (RFC 8949): cbor2 with `canonical=True` and
//! QCBOR shorten each float that they can. The deserializer that SCL uses reads neither.
#![deny(missing_docs)]

const BYTES: u8 = 2;
const TEXT: u8 = 3;
const TAG: u8 = 6;
const SIMPLE: u8 = 7;
/// Tags of integers of more than 64 bits, which the deserializer reads.
const BIG_NUMBERS: [u64; 2] = [2, 3];
/// The low bits of the first byte of a 16-bit float.
const HALF: u8 = 25;
/// The first byte of a 32-bit float.
const SINGLE: u8 = 0xfa;

/// Removes tags, and widens 16-bit floats to 32 bits. Returns `None` if the frame has neither, or is not CBOR.
///
/// A tag says what an item means; the item under it stays as it is. Tags of big numbers are kept.
///
/// ```
/// // A date (tag 1) as a float of 16 bits.
/// assert_eq!(scl_cbor::simplify(b"\xc1\xf9\x3e\x00"), Some(b"\xfa\x3f\xc0\x00\x00".to_vec()));
/// assert_eq!(scl_cbor::simplify(b"\xfa\x3f\xc0\x00\x00"), None);
/// ```
pub fn simplify(frame: &[u8]) -> Option<Vec<u8>> {
    let mut simple = Vec::new();
    let mut copied = 0;
    let mut at = 0;
    // The items of an array or a map follow its head, so a flat loop finds every head.
    while let Some(&first) = frame.get(at) {
        let (major, low) = (first >> 5, first & 0x1f);
        let (argument, head) = argument(&frame[at..])?;
        let end = match (major, low) {
            (BYTES | TEXT, ..31) => (at + head).checked_add(usize::try_from(argument).ok()?)?,
            _ => at + head,
        };
        if end > frame.len() {
            return None;
        }
        let is_tag = major == TAG && !BIG_NUMBERS.contains(&argument);
        let is_half = (major, low) == (SIMPLE, HALF);
        if is_tag || is_half {
            simple.extend_from_slice(&frame[copied..at]);
            copied = end;
        }
        if is_half {
            simple.push(SINGLE);
            simple.extend_from_slice(&widened(argument as u16).to_be_bytes());
        }
        at = end;
    }
    simple.extend_from_slice(&frame[copied..]);
    (copied > 0).then_some(simple)
}

/// The argument of an item, and the length of its head; `None` if it is malformed.
fn argument(item: &[u8]) -> Option<(u64, usize)> {
    let (first, rest) = item.split_first()?;
    let length = match first & 0x1f {
        low @ 0..24 => return Some((u64::from(low), 1)),
        24 => 1,
        25 => 2,
        26 => 4,
        27 => 8,
        // Indefinite length: ends with a break.
        31 => 0,
        _ => return None,
    };
    let argument = rest.get(..length)?.iter().fold(0, |number, byte| number << 8 | u64::from(*byte));
    Some((argument, 1 + length))
}

/// Widens a 16-bit float (IEEE 754 binary16) to 32 bits.
fn widened(half: u16) -> f32 {
    let sign = if half >> 15 == 0 { 1.0 } else { -1.0 };
    let (exponent, fraction) = (half >> 10 & 0x1f, half & 0x3ff);
    match (exponent, fraction) {
        (0x1f, 0) => sign * f32::INFINITY,
        (0x1f, _) => f32::NAN,
        (0, _) => sign * f32::from(fraction) * 2_f32.powi(-24),
        _ => sign * f32::from(fraction | 0x400) * 2_f32.powi(i32::from(exponent) - 25),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn float(value: f32) -> Vec<u8> {
        [&[SINGLE][..], &value.to_be_bytes()].concat()
    }

    /// The examples of RFC 8949, appendix A.
    #[test]
    fn floats_of_16_bits_are_widened() {
        for (half, value) in [
            (0x0000, 0.0),
            (0x8000, -0.0),
            (0x3c00, 1.0),
            (0x3e00, 1.5),
            (0x7bff, 65504.0),
            (0x0001, 5.960_464_5e-8),
            (0x0400, 0.000_061_035_156),
            (0xc400, -4.0),
            (0x7c00, f32::INFINITY),
            (0xfc00, f32::NEG_INFINITY),
        ] {
            let frame = [&[0xf9][..], &u16::to_be_bytes(half)].concat();
            assert_eq!(simplify(&frame), Some(float(value)), "{half:x}");
        }
        assert!(widened(0x7e00).is_nan());
    }

    #[test]
    fn tags_are_removed_wherever_they_are() {
        let cases: [(&[u8], &[u8]); 7] = [
            // Self-described CBOR around a map with tagged keys and values, in maps of a known and of any length.
            (b"\xd9\xd9\xf7\xa1\xc0\x61x\xd8\x18\x07", b"\xa1\x61x\x07"),
            (b"\xbf\xc1\x01\xd8\x40\x42\xc1\xc1\xff", b"\xbf\x01\x42\xc1\xc1\xff"),
            (b"\xc1\xc1\xc1\x00", b"\x00"),
            (b"\x82\xda\xff\xff\xff\xff\x01\xdb\0\0\0\0\0\0\0\x07\x02", b"\x82\x01\x02"),
            // A byte string in pieces.
            (b"\xc1\x5f\x42\xf9\xf9\x41\xc1\xff", b"\x5f\x42\xf9\xf9\x41\xc1\xff"),
            (b"\x82\xc2\x49\x01\0\0\0\0\0\0\0\0\xc1\x01", b"\x82\xc2\x49\x01\0\0\0\0\0\0\0\0\x01"),
            (b"\x9f\xf9\x3c\0\xf9\xbc\0\xff", b"\x9f\xfa\x3f\x80\0\0\xfa\xbf\x80\0\0\xff"),
        ];
        for (frame, expected) in cases {
            assert_eq!(simplify(frame).as_deref(), Some(expected), "{frame:x?}");
        }
    }

    #[test]
    fn other_frames_stay_as_they_are() {
        let cases: [&[u8]; 9] = [
            b"",
            b"\xa1\x61x\x07",
            b"\x63\xf9\xc1\xd8",
            b"\xf9\x3c",
            b"\xc1\xdb\0",
            b"\xc1\x5b\xff\xff\xff\xff\xff\xff\xff\xff",
            b"\xc1\x1c",
            b"\xc1\x63ab",
            b"\xc2\x41\x01",
        ];
        for frame in cases {
            assert_eq!(simplify(frame), None, "{frame:x?}");
        }
    }
}
