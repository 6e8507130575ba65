//! Random numbers: from one seed, a generator for each purpose. The numbers drawn for one purpose do not affect those
//! of another.

use rand::SeedableRng;
use rand::rngs::StdRng;

/// What random numbers are for.
pub(super) enum Purpose {
    /// The visits of the primary user of a channel.
    PrimaryUser(u32),
    /// The samples of a quiet period, by its step.
    Block(u64),
}

pub(super) fn generator(seed: u64, purpose: Purpose) -> StdRng {
    let (kind, number) = match purpose {
        Purpose::PrimaryUser(channel) => (0, u64::from(channel)),
        Purpose::Block(step) => (1, step),
    };
    let mut bytes = [0; 32];
    bytes[..8].copy_from_slice(&seed.to_le_bytes());
    bytes[8..16].copy_from_slice(&number.to_le_bytes());
    bytes[16] = kind;
    StdRng::from_seed(bytes)
}
