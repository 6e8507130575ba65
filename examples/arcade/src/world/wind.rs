//! Wind: a constant mean, and gusts as a first-order Gauss-Markov process.

use super::noise::{Noise, Wander};
use glam::DVec3;

const GUST_TIME: f64 = 2.0; // s
/// Vertical gusts are weaker, by this factor.
const VERTICAL: f64 = 0.3;
/// Below this height the ground slows the air down, m.
const BOUNDARY: f64 = 2.0;

/// The air's motion.
#[derive(Debug)]
pub struct Wind {
    mean: DVec3,
    gusts: [Wander; 3],
    noise: Noise,
}

impl Wind {
    /// A wind from the west, with gusts of the standard deviation `gusts`, m/s.
    pub fn new(mean: f64, gusts: f64, seed: u64) -> Self {
        let gust = |sigma| Wander::new(sigma, GUST_TIME);
        Self {
            mean: DVec3::X * mean,
            gusts: [gust(gusts), gust(gusts), gust(gusts * VERTICAL)],
            noise: Noise::new(seed, "wind"),
        }
    }

    pub fn step(&mut self, elapsed: f64) {
        self.gusts.iter_mut().for_each(|gust| gust.step(&mut self.noise, elapsed));
    }

    /// Wind at a height above the ground, m/s.
    pub fn at_height(&self, height: f64) -> DVec3 {
        let [x, y, z] = self.gusts.each_ref().map(|gust| gust.value);
        (self.mean + DVec3::new(x, y, z)) * (height / BOUNDARY).clamp(0.0, 1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_gusts_are_as_asked() {
        let mut wind = Wind::new(3.0, 1.0, 7);
        let samples: Vec<f64> = (0..100_000)
            .map(|_| {
                wind.step(0.1);
                wind.at_height(10.0).x
            })
            .collect();
        let mean = samples.iter().sum::<f64>() / samples.len() as f64;
        let variance = samples.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / samples.len() as f64;
        assert!((mean - 3.0).abs() < 0.1, "{mean}");
        assert!((variance.sqrt() - 1.0).abs() < 0.05, "{variance}");
    }

    #[test]
    fn the_air_stands_still_at_the_ground() {
        assert_eq!(Wind::new(3.0, 1.0, 7).at_height(0.0), DVec3::ZERO);
    }
}
