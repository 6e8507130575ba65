//! Random numbers of a simulation, which are the same in all releases.

use std::time::Duration;

/// A sequence of numbers (SplitMix64).
#[derive(Debug, Clone)]
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let number = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        number ^ (number >> 31)
    }

    /// A number below `end`, which must not be 0.
    pub(crate) fn below(&mut self, end: u64) -> u64 {
        // The upper half of the product: the bias is far below anything that a simulation could show.
        ((u128::from(self.next()) * u128::from(end)) >> 64) as u64
    }

    /// A duration, each equally likely.
    pub(crate) fn between(&mut self, between: Between) -> Duration {
        let Between { least, most } = between;
        let width = u64::try_from((most - least).as_nanos()).unwrap_or(u64::MAX - 1);
        least + Duration::from_nanos(self.below(width + 1))
    }
}

/// Durations from the least to the most.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Between {
    /// The shortest one.
    pub least: Duration,
    /// The longest one, which may be the same.
    pub most: Duration,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stay_the_same_and_in_their_range() {
        let mut random = Random::new(0);
        assert_eq!([random.next(), random.next()], [0xe220_a839_7b1d_cdaf, 0x6e78_9e6a_a1b9_65f4]);
        let between = Between { least: Duration::from_millis(2), most: Duration::from_millis(3) };
        let drawn: Vec<Duration> = (0..1000).map(|_| random.between(between)).collect();
        assert!(drawn.iter().all(|it| (between.least..=between.most).contains(it)));
        assert!(drawn.iter().any(|it| *it < Duration::from_micros(2100)));
        assert!(drawn.iter().any(|it| *it > Duration::from_micros(2900)));
        let same = Between { least: between.least, most: between.least };
        assert_eq!(random.between(same), between.least);
    }
}
