//! Random numbers that repeat: the same seed gives the same flight.

use rand::SeedableRng;
use rand::rngs::StdRng;
use rand_distr::{Distribution, StandardNormal};

/// A source of white noise.
#[derive(Debug)]
pub struct Noise(StdRng);

impl Noise {
    /// The purpose makes the noise of each sensor independent of that of the others.
    pub fn new(seed: u64, purpose: &str) -> Self {
        let key = purpose.bytes().fold(seed, |key, byte| key.wrapping_mul(0x0100_0000_01b3) ^ u64::from(byte));
        Self(StdRng::seed_from_u64(key))
    }

    /// Returns a normally distributed value with mean 0 and standard deviation `sigma`.
    pub fn normal(&mut self, sigma: f64) -> f64 {
        let normal: f64 = StandardNormal.sample(&mut self.0);
        normal * sigma
    }

    /// Three independent values.
    pub fn vector(&mut self, sigma: f64) -> glam::DVec3 {
        glam::DVec3::new(self.normal(sigma), self.normal(sigma), self.normal(sigma))
    }
}

/// A value that wanders around zero: a first-order Gauss-Markov process (Gelb, Applied Optimal Estimation, 1974).
#[derive(Clone, Copy, Debug)]
pub struct Wander {
    pub value: f64,
    sigma: f64,
    /// Correlation time, s.
    time: f64,
}

impl Wander {
    /// A process with standard deviation `sigma` and correlation time `time`, starting at zero.
    pub fn new(sigma: f64, time: f64) -> Self {
        Self { value: 0.0, sigma, time }
    }

    /// Advances by `elapsed` seconds; exact for steps of any length.
    pub fn step(&mut self, noise: &mut Noise, elapsed: f64) {
        let kept = (-elapsed / self.time).exp();
        self.value = kept * self.value + noise.normal(self.sigma * (1.0 - kept * kept).sqrt());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_repeats_and_purposes_differ() {
        let first = |seed, purpose| Noise::new(seed, purpose).normal(1.0);
        assert_eq!(first(1, "wind"), first(1, "wind"));
        assert_ne!(first(1, "wind"), first(2, "wind"));
        assert_ne!(first(1, "wind"), first(1, "gps"));
    }

    #[test]
    fn the_spread_does_not_depend_on_the_step() {
        for elapsed in [0.01, 0.5, 20.0] {
            let (mut noise, mut wander) = (Noise::new(3, "test"), Wander::new(2.0, 1.0));
            let squares: f64 = (0..200_000)
                .map(|_| {
                    wander.step(&mut noise, elapsed);
                    wander.value * wander.value
                })
                .sum();
            let sigma = (squares / 200_000.0).sqrt();
            assert!((sigma - 2.0).abs() < 0.15, "{sigma} at {elapsed}");
        }
    }
}
