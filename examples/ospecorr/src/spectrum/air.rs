//! The air in steps of one frame: which frames arrive, and the samples of quiet periods.

use super::primary_users::PrimaryUsers;
use super::random::{self, Purpose};
use super::signal::Receiver;
use crate::band::{BLOCK, CHANNELS, FRAME_TIME, FRAMES_PER_SLOT, SAMPLE_RATE};
use crate::ospecorr::{Frame, Received, Samples, Truth};

const STEP_US: u64 = FRAME_TIME.as_micros() as u64;
const BLOCK_US: u64 = (BLOCK as f64 / SAMPLE_RATE * 1e6) as u64;

/// The band, its primary users, and the far end of the link.
pub struct Air {
    primary_users: PrimaryUsers,
    receiver: Receiver,
    seed: u64,
    /// Number of steps so far, which is the clock.
    step: u64,
    /// The channel of the last frame of this slot.
    used: Option<u32>,
    lost: u32,
}

impl Air {
    /// Creates the band at time 0.
    pub fn new(primary_users: PrimaryUsers, snr_db: f64, seed: u64) -> Self {
        Self { primary_users, receiver: Receiver::new(snr_db), seed, step: 0, used: None, lost: 0 }
    }

    /// Returns true if this step is a quiet period.
    pub fn is_quiet(&self) -> bool {
        self.step % (FRAMES_PER_SLOT + 1) == FRAMES_PER_SLOT
    }

    /// Frames that have collided with a primary user so far.
    pub fn lost(&self) -> u32 {
        self.lost
    }

    /// Advances by a step in which the radio sends `frame`, if any, on `channel`. Returns what arrives at the far end.
    /// A frame on a channel outside of the band is lost.
    pub fn carry(&mut self, channel: u32, frame: Option<Frame>) -> Option<Received> {
        let (begin_us, end_us) = (self.time_us(), self.time_us() + STEP_US);
        self.step += 1;
        let frame = frame?;
        self.used = Some(channel);
        if channel >= CHANNELS || self.primary_users.channels(begin_us, end_us).contains(&channel) {
            self.lost += 1;
            return None;
        }
        let length = u32::try_from(frame.data.len()).unwrap_or(u32::MAX);
        Some(Received { time_us: end_us, number: frame.number, length, channel })
    }

    /// Advances by a quiet period, and returns samples of the band and the truth at this time. The radio sends no frame
    /// now, so it is not in the samples; `channel` is the channel that it is set to.
    pub fn listen(&mut self, channel: u32) -> (Samples, Truth) {
        let time_us = self.time_us();
        let channels = self.primary_users.channels(time_us, time_us + BLOCK_US);
        let iq = self.receiver.block(&channels, &mut random::generator(self.seed, Purpose::Block(self.step)));
        let truth = Truth {
            time_us,
            primary_channels: channels,
            channel: self.used.unwrap_or(channel),
            transmitting: self.used.is_some(),
            lost: self.lost,
        };
        self.step += 1;
        self.used = None;
        (Samples { time_us, sample_rate: SAMPLE_RATE, channels: CHANNELS, iq }, truth)
    }

    fn time_us(&self) -> u64 {
        self.step * STEP_US
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slot_is_four_frames_and_a_quiet_period() {
        let mut air = air(&[]);
        for slot in 0..3 {
            for count in 1..=4 {
                assert!(!air.is_quiet());
                let received = air.carry(2, frame()).unwrap();
                assert_eq!(
                    received,
                    Received { time_us: slot * 20_000 + count * 4_000, number: 7, length: 3, channel: 2 }
                );
            }
            assert!(air.is_quiet());
            let (samples, truth) = air.listen(0);
            assert_eq!(samples.time_us, slot * 20_000 + 16_000);
            assert_eq!(truth.time_us, samples.time_us);
            assert_eq!(samples.iq.len(), 2 * BLOCK);
        }
    }

    #[test]
    fn frames_collide_on_the_channel_of_a_primary_user_alone() {
        // From the middle of the second frame to the middle of the fourth.
        let mut air = air(&["2@0.006..0.014"]);
        assert!(air.carry(2, frame()).is_some());
        assert!(air.carry(2, frame()).is_none());
        assert!(air.carry(3, frame()).is_some());
        assert!(air.carry(2, frame()).is_none());
        assert_eq!(air.lost(), 2);
        let truth = air.listen(0).1;
        assert_eq!((truth.lost, truth.primary_channels), (2, vec![]));
    }

    #[test]
    fn the_truth_is_that_of_the_slot() {
        let mut air = air(&["4@0..1"]);
        air.carry(1, frame());
        air.carry(2, frame());
        air.carry(3, None);
        air.carry(3, None);
        let truth = air.listen(3).1;
        assert_eq!((truth.channel, truth.transmitting, truth.primary_channels), (2, true, vec![4]));

        for _ in 0..4 {
            air.carry(5, None);
        }
        let truth = air.listen(5).1;
        assert_eq!((truth.channel, truth.transmitting), (5, false));
    }

    #[test]
    fn a_frame_on_a_channel_outside_of_the_band_is_lost() {
        let mut air = air(&[]);
        assert_eq!(air.carry(CHANNELS, frame()), None);
        assert_eq!(air.lost(), 1);
    }

    #[test]
    fn samples_depend_on_the_seed_and_on_the_time_alone() {
        let iq = |seed, send| {
            let mut air = Air::new(PrimaryUsers::random(seed), 10.0, seed);
            let mut blocks = Vec::new();
            for _ in 0..3 {
                for _ in 0..4 {
                    air.carry(1, frame().filter(|_| send));
                }
                blocks.push(air.listen(0).0.iq);
            }
            blocks
        };
        assert_eq!(iq(1, true), iq(1, false));
        assert_ne!(iq(1, true), iq(2, true));
        assert_ne!(iq(1, true)[0], iq(1, true)[1]);
    }

    fn air(visits: &[&str]) -> Air {
        let visits = visits.iter().map(|it| it.parse().unwrap()).collect();
        Air::new(PrimaryUsers::Scheduled(visits), 10.0, 1)
    }

    fn frame() -> Option<Frame> {
        Some(Frame { number: 7, data: vec![1, 2, 3] })
    }
}
