//! Detection of the ground: after touching down, the vehicle stands still although its set-point continues to sink.
//!
//! The conditions of PX4's land detector: low, no vertical movement, and little thrust, for a while.

use super::parameters::Parameters;

const LOW: f64 = 0.5; // m
const STILL: f64 = 0.2; // m/s
/// Share of the hover thrust. In the air, thrust this low would mean a fall.
const LITTLE_THRUST: f64 = 0.6;
const HOLD: f64 = 0.5; // s

/// Measures for how long the vehicle has seemed to stand still.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LandDetector {
    /// Seconds.
    pub still: f64,
}

impl LandDetector {
    /// Returns true once the vehicle has stood for long enough. `thrust` is the motors' mean set-point.
    pub fn update(&mut self, height: f64, climb: f64, thrust: f64, parameters: &Parameters, elapsed: f64) -> bool {
        let stands = height < LOW && climb.abs() < STILL && thrust < LITTLE_THRUST * parameters.thrust_hover;
        self.still = if stands { self.still + elapsed } else { 0.0 };
        self.still >= HOLD
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How many of 300 beats pass until the detector fires.
    fn beats(height: f64, climb: f64, thrust: f64) -> Option<usize> {
        let mut detector = LandDetector::default();
        (1..=300).find(|_| detector.update(height, climb, thrust, &Parameters::defaults(), 1.0 / 300.0))
    }

    #[test]
    fn standing_for_half_a_second_is_a_landing() {
        assert!(beats(0.1, 0.0, 0.1).is_some_and(|beats| (150..=151).contains(&beats)));
    }

    #[test]
    fn hovering_sinking_or_falling_is_none() {
        assert_eq!(beats(0.1, 0.0, 0.45), None);
        assert_eq!(beats(0.1, -0.5, 0.1), None);
        assert_eq!(beats(3.0, 0.0, 0.1), None);
    }
}
