//! What a receiver of the whole band would sample: noise, and the signals of primary users.

use std::f64::consts::{FRAC_1_SQRT_2, PI, TAU};

use rand::RngExt;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};

use crate::band::{self, BLOCK, CHANNELS, SAMPLE_RATE};

/// 0.8 million symbols a second, which with the roll-off below fill a channel of 1 MHz.
const SAMPLES_PER_SYMBOL: usize = 10;
const ROLL_OFF: f64 = 0.25;

/// The length of the pulse in symbols; cutting it off there leaves less than -40 dB in the next channel.
const SPAN: usize = 16;

/// Makes blocks of samples.
pub struct Receiver {
    pulse: Vec<f64>,
    /// Amplitude of a primary user's signal; the noise has amplitude 1.
    amplitude: f64,
}

impl Receiver {
    /// Creates a receiver. `snr_db` is the power of a primary user above that of the noise in its channel.
    pub fn new(snr_db: f64) -> Self {
        let power = 10f64.powf(snr_db / 10.0) / f64::from(CHANNELS);
        Self { pulse: pulse(), amplitude: power.sqrt() }
    }

    /// Returns a block with primary users on these channels, with real and imaginary parts in turn. The white noise has
    /// power 1 in the whole band.
    pub fn block(&self, channels: &[u32], rng: &mut StdRng) -> Vec<f32> {
        let mut iq: Vec<f64> =
            StandardNormal.sample_iter(&mut *rng).take(2 * BLOCK).map(|it: f64| it * FRAC_1_SQRT_2).collect();
        for &channel in channels {
            self.add_primary_user(&mut iq, channel, rng);
        }
        iq.into_iter().map(|it| it as f32).collect()
    }

    /// Adds random QPSK symbols, shaped by the pulse and moved to a channel. The phase and symbol clock of a primary
    /// user are not synchronized with this receiver, so both are random in each block.
    fn add_primary_user(&self, iq: &mut [f64], channel: u32, rng: &mut StdRng) {
        let symbols: Vec<[f64; 2]> = (0..BLOCK / SAMPLES_PER_SYMBOL + 2 + SPAN)
            .map(|_| [(); 2].map(|()| if rng.random() { FRAC_1_SQRT_2 } else { -FRAC_1_SQRT_2 }))
            .collect();
        let timing = rng.random_range(0..SAMPLES_PER_SYMBOL);
        let phase = rng.random_range(0.0..TAU);
        let turn = TAU * band::centre(channel) / SAMPLE_RATE;
        for (n, sample) in iq.chunks_exact_mut(2).enumerate() {
            let (symbol, offset) = ((timing + n) / SAMPLES_PER_SYMBOL, (timing + n) % SAMPLES_PER_SYMBOL);
            let mut shaped = [0.0; 2];
            // The pulses of the last `SPAN` symbols overlap in this sample; the newest pulse has just begun.
            let newest_first = symbols[symbol..symbol + SPAN].iter().rev();
            for ([re, im], tap) in newest_first.zip(self.pulse[offset..].iter().step_by(SAMPLES_PER_SYMBOL)) {
                shaped[0] += re * tap;
                shaped[1] += im * tap;
            }
            let (sin, cos) = (phase + turn * n as f64).sin_cos();
            sample[0] += self.amplitude * (shaped[0] * cos - shaped[1] * sin);
            sample[1] += self.amplitude * (shaped[0] * sin + shaped[1] * cos);
        }
    }
}

/// A root raised cosine (Proakis, Digital Communications, section 9.2) whose symbols have a mean power of 1.
fn pulse() -> Vec<f64> {
    let length = SPAN * SAMPLES_PER_SYMBOL;
    let taps: Vec<f64> =
        (0..length).map(|n| root_raised_cosine((n as f64 - length as f64 / 2.0) / SAMPLES_PER_SYMBOL as f64)).collect();
    let energy: f64 = taps.iter().map(|tap| tap * tap).sum();
    let scale = (SAMPLES_PER_SYMBOL as f64 / energy).sqrt();
    taps.into_iter().map(|tap| tap * scale).collect()
}

/// Returns the root raised cosine at time `t`, in symbols.
fn root_raised_cosine(t: f64) -> f64 {
    let edge = 4.0 * ROLL_OFF * t;
    if t == 0.0 {
        1.0 - ROLL_OFF + 4.0 * ROLL_OFF / PI
    } else if edge.abs() == 1.0 {
        let angle = PI / (4.0 * ROLL_OFF);
        ROLL_OFF * FRAC_1_SQRT_2 * ((1.0 + 2.0 / PI) * angle.sin() + (1.0 - 2.0 / PI) * angle.cos())
    } else {
        let oscillation = (PI * t * (1.0 - ROLL_OFF)).sin() + edge * (PI * t * (1.0 + ROLL_OFF)).cos();
        oscillation / (PI * t * (1.0 - edge * edge))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;

    #[test]
    fn noise_alone_is_equally_strong_in_all_channels() {
        for (channel, power) in mean_powers(10.0, &[]).into_iter().enumerate() {
            assert!((power - 0.125).abs() < 0.125 * 0.05, "{power} in channel {channel}");
        }
    }

    #[test]
    fn primary_users_have_their_power_in_their_channels_alone() {
        for snr_db in [-3.0, 10.0, 20.0] {
            let signal = 0.125 * 10f64.powf(snr_db / 10.0);
            for (channel, power) in mean_powers(snr_db, &[0, 3, 7]).into_iter().enumerate() {
                let expected = if [0, 3, 7].contains(&channel) { signal + 0.125 } else { 0.125 };
                // The statistics of 200 blocks, and less than -30 dB of each of the two neighbours.
                let tolerance = 0.05 * expected + 0.002 * signal;
                assert!((power - expected).abs() < tolerance, "{power}, not {expected}, in {channel} at {snr_db} dB");
            }
        }
    }

    #[test]
    fn a_seed_gives_the_same_block() {
        let block = |seed| Receiver::new(10.0).block(&[2], &mut StdRng::seed_from_u64(seed));
        assert_eq!(block(1), block(1));
        assert_ne!(block(1), block(2));
        assert_eq!(block(1).len(), 2 * BLOCK);
    }

    /// The mean power in each channel; all of them together are the mean power of a sample.
    fn mean_powers(snr_db: f64, channels: &[u32]) -> Vec<f64> {
        const BLOCKS: usize = 200;
        let receiver = Receiver::new(snr_db);
        let mut rng = StdRng::seed_from_u64(1);
        let mut powers = vec![0.0; CHANNELS as usize];
        for _ in 0..BLOCKS {
            let samples: Vec<[f64; 2]> =
                receiver.block(channels, &mut rng).chunks_exact(2).map(|it| [it[0].into(), it[1].into()]).collect();
            let windowed: Vec<[f64; 2]> = samples.iter().zip(hann()).map(|(it, w)| it.map(|part| part * w)).collect();
            for (bin, [re, im]) in transform(&windowed).into_iter().enumerate() {
                // The second half of the bins is the lower half of the band.
                let channel = (bin + BLOCK / 2) % BLOCK / (BLOCK / CHANNELS as usize);
                powers[channel] += (re * re + im * im) / (BLOCK * BLOCK * BLOCKS) as f64;
            }
        }
        powers
    }

    /// The Hann window, scaled so that it keeps the mean power. Without it, the ends of a block would spread the power
    /// of a signal over the band.
    fn hann() -> impl Iterator<Item = f64> {
        (0..BLOCK).map(|n| (1.0 - (TAU * n as f64 / BLOCK as f64).cos()) / 1.5f64.sqrt())
    }

    /// The fast Fourier transform (Cooley and Tukey, 1965).
    fn transform(samples: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let n = samples.len();
        if n == 1 {
            return samples.to_vec();
        }
        let half = |first| transform(&samples.iter().skip(first).step_by(2).copied().collect::<Vec<_>>());
        let (even, odd) = (half(0), half(1));
        let mut bins = vec![[0.0; 2]; n];
        for (k, (even, odd)) in even.into_iter().zip(odd).enumerate() {
            let (sin, cos) = (-TAU * k as f64 / n as f64).sin_cos();
            let turned = [odd[0] * cos - odd[1] * sin, odd[0] * sin + odd[1] * cos];
            bins[k] = [even[0] + turned[0], even[1] + turned[1]];
            bins[k + n / 2] = [even[0] - turned[0], even[1] - turned[1]];
        }
        bins
    }
}
