//! The band and its time slots, which the spectrum and the radio have to agree on.
//!
//! Time is divided into slots: data, then a quiet period in which every radio of the network is silent so that what
//! remains in the band is noise and primary users. Quiet periods are those of IEEE Std 802.22-2011, but the lengths are
//! this example's: in the standard, a frame takes 10 ms, a superframe has 16 of them, and a primary user has to be
//! detected within 2 s.

use std::time::Duration;

/// Channels of 1 MHz, counted from the lower end of the band.
pub const CHANNELS: u32 = 8;

/// Complex samples a second, which is also the width of the band in Hz.
pub const SAMPLE_RATE: f64 = 8e6;

/// Complex samples taken in a quiet period: 128 us of them, 128 for each channel.
pub const BLOCK: usize = 1024;

/// The time that a frame takes on the air.
pub const FRAME_TIME: Duration = Duration::from_millis(4);

/// Frames in a slot; the quiet period after them is as long as another one. So a slot is 20 ms, and the air carries 200
/// frames a second.
pub const FRAMES_PER_SLOT: u64 = 4;

/// The middle of a channel in Hz, from the middle of the band.
pub fn centre(channel: u32) -> f64 {
    (f64::from(channel) + 0.5) * SAMPLE_RATE / f64::from(CHANNELS) - SAMPLE_RATE / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_fill_the_band() {
        assert_eq!(centre(0), -3.5e6);
        assert_eq!(centre(CHANNELS - 1), 3.5e6);
    }
}
