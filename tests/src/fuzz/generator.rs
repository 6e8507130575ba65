//! Input for `cargo test`, the same in every run.

/// Numbers that only look random.
pub struct Generator(u64);

impl Generator {
    /// A generator of its own numbers for each seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    /// A number below `limit`, which is not 0.
    pub fn below(&mut self, limit: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 16) as usize % limit
    }

    /// At most `most` bytes of noise.
    pub fn noise(&mut self, most: usize) -> Vec<u8> {
        let length = self.below(most + 1);
        (0..length).map(|_| self.below(256) as u8).collect()
    }

    /// Sound bytes with up to four changes: cut, grown, repeated many times, or with other bytes in their place.
    pub fn damaged(&mut self, sound: &[u8]) -> Vec<u8> {
        let mut bytes = sound.to_vec();
        for _ in 0..=self.below(4) {
            let start = self.below(bytes.len() + 1);
            let end = (start + self.below(12)).min(bytes.len());
            match self.below(6) {
                0 => bytes.truncate(start),
                1 => drop(bytes.drain(start..end)),
                2 => drop(bytes.splice(start..start, self.noise(10))),
                3 => {
                    let many = bytes[start..end].repeat(self.below(400));
                    drop(bytes.splice(start..start, many));
                }
                _ => bytes[start..end].fill_with(|| TELLING[self.below(TELLING.len())]),
            }
        }
        bytes
    }
}

/// Bytes that mean something to one codec or another, mostly a length.
const TELLING: [u8; 24] = [
    0x00, 0x01, 0x02, 0x0a, 0x7f, 0x80, 0x81, 0x90, 0x9b, 0x9f, 0xa1, 0xbf, 0xc0, 0xc6, 0xdc, 0xdd, 0xdf, 0xf6, 0xf9,
    0xff, b'[', b'{', b'"', b'9',
];
