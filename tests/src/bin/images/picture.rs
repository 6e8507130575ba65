//! A message of fixed layout, and what the frames of bytes contain.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Bytes of a picture: with its number, 4 MiB.
const PIXELS: usize = (4 << 20) - 8;

#[derive(FromBytes, IntoBytes, KnownLayout, Immutable)]
#[repr(C)]
pub(crate) struct Picture {
    pub(crate) number: u64,
    pub(crate) pixels: [u8; PIXELS],
}

impl Picture {
    pub(crate) fn draw(&mut self, number: u64) {
        self.number = number;
        self.pixels.fill(number as u8);
    }

    /// Whether all of it is from the same picture.
    pub(crate) fn is_whole(&self) -> bool {
        self.pixels.iter().all(|pixel| *pixel == self.number as u8)
    }
}

/// Fills a frame with its number: 8 bytes at the start, the lowest one in the rest.
pub(crate) fn fill(frame: &mut [u8], number: u64) {
    frame[..8].copy_from_slice(&number.to_le_bytes());
    frame[8..].fill(number as u8);
}

/// The number of a frame.
///
/// # Panics
/// If parts of it are from another frame.
pub(crate) fn number_of(frame: impl AsRef<[u8]>) -> u64 {
    let frame = frame.as_ref();
    let number = u64::from_le_bytes(frame[..8].try_into().expect("8 bytes"));
    assert!(frame[8..].iter().all(|byte| *byte == number as u8), "frame {number} is damaged");
    number
}
