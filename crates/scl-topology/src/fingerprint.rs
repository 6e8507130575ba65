//! Hashes that become part of file names. Programs of different versions and languages must agree on them, so they are
//! written out here and never change.

/// The characters of a hash: letters and digits that survive file systems which ignore case.
const ALPHABET: &[u8; 32] = b"abcdefghijklmnopqrstuvwxyz234567";

/// The length of a [`short`] hash, in characters.
pub(crate) const SHORT_LENGTH: usize = 8;

/// The length of a [`long`] hash, in characters.
const LONG_LENGTH: usize = 26;

/// Forty bits of FNV-1a (64 bits) over the parts, as eight characters of `a-z2-7`.
pub(crate) fn short<'a>(parts: impl IntoIterator<Item = &'a str>) -> String {
    let mut hash: u64 = 0xcbf2_9ce4_8422_2325;
    for part in parts {
        // The zero after each part keeps `ab`, `c` and `a`, `bc` apart.
        for byte in part.bytes().chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
    // Only the upper bits of the product depend on every byte, so they are folded into the lower ones.
    encode((hash ^ (hash >> 40)).into(), SHORT_LENGTH)
}

/// FNV-1a (128 bits) over `bytes`, as 26 characters of `a-z2-7`.
///
/// Long enough that two different inputs never share a name by accident. It does not resist an attacker who looks for
/// two inputs with the same hash.
pub fn long(bytes: &[u8]) -> String {
    const OFFSET: u128 = 0x6c62_272e_07bb_0142_62b8_2175_6295_c58d;
    const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
    let hash = bytes.iter().fold(OFFSET, |hash, &byte| (hash ^ u128::from(byte)).wrapping_mul(PRIME));
    encode(hash, LONG_LENGTH)
}

/// The lowest `5 * length` bits, lowest first.
fn encode(hash: u128, length: usize) -> String {
    (0..length).map(|at| char::from(ALPHABET[(hash >> (5 * at)) as usize % ALPHABET.len()])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_hashes_never_change() {
        assert_eq!(short([""; 0]), "znutocs4");
        assert_eq!(short(["ab", "c"]), "cmzg4j5f");
        assert_ne!(short(["ab", "c"]), short(["a", "bc"]));
    }

    #[test]
    fn long_hashes_never_change() {
        // The published value of FNV-1a with 128 bits for `foobar`, in base 32.
        assert_eq!(long(b"foobar"), encode(0x343e_1662_793c_64bf_6f0d_3597_ba44_6f18, LONG_LENGTH));
        assert_eq!(long(b""), encode(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d, LONG_LENGTH));
        assert_eq!(long(b"foobar").len(), LONG_LENGTH);
    }
}
