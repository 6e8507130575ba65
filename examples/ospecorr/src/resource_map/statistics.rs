//! Statistics of each channel over a period of observations.

use crate::ospecorr::statistics::Channel;

/// An observation of a channel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Microseconds since 1970.
    pub time_us: i64,
    /// Number of the channel in the band.
    pub channel: u32,
    /// Mean power above the noise floor.
    pub power_db: f64,
    /// Whether the channel was in use.
    pub occupied: bool,
}

/// Nothing is known about a channel between observations further apart than this, so an idle time ends there.
const LONGEST_GAP_US: i64 = 1_000_000;

/// Sums up observations in the order of their times.
#[derive(Default)]
pub struct Summary {
    channels: Vec<Sums>,
}

#[derive(Clone, Default)]
struct Sums {
    observations: u32,
    occupied: u32,
    /// Sum of powers, not of decibels: the mean of -10 dB and 10 dB is 7 dB, not 0 dB.
    power: f64,
    idle_us: i64,
    idle_times: u32,
    last: Option<Observation>,
}

impl Summary {
    /// Adds an observation.
    pub fn add(&mut self, now: Observation) {
        let index = now.channel as usize;
        if index >= self.channels.len() {
            self.channels.resize(index + 1, Sums::default());
        }
        let sums = &mut self.channels[index];
        sums.observations += 1;
        sums.occupied += u32::from(now.occupied);
        sums.power += 10f64.powf(now.power_db / 10.0);
        let idle_since = sums.last.filter(|last| !last.occupied && now.time_us - last.time_us <= LONGEST_GAP_US);
        match idle_since {
            Some(last) => sums.idle_us += now.time_us - last.time_us,
            None => sums.idle_times += u32::from(!now.occupied),
        }
        sums.last = Some(now);
    }

    /// Returns the statistics of each channel, from channel 0. Idle times that were cut off by the beginning or the end
    /// of the observations count as far as they were observed.
    pub fn finish(self) -> Vec<Channel> {
        self.channels.into_iter().map(Sums::finish).collect()
    }
}

impl Sums {
    fn finish(self) -> Channel {
        let mean = |sum: f64, count: u32| if count == 0 { 0.0 } else { sum / f64::from(count) };
        Channel {
            observations: self.observations,
            occupied: mean(f64::from(self.occupied), self.observations),
            mean_idle: mean(self.idle_us as f64 / 1e6, self.idle_times),
            mean_power_db: if self.power > 0.0 { 10.0 * mean(self.power, self.observations).log10() } else { 0.0 },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Observations of channel 0, one in a tenth of a second: `x` is occupied, a space is a time without any.
    fn summary(observations: &str) -> Channel {
        let mut summary = Summary::default();
        for (time_us, letter) in (0..).step_by(100_000).zip(observations.chars()) {
            let occupied = letter == 'x';
            if letter != ' ' {
                let power_db = if occupied { 10.0 } else { 0.0 };
                summary.add(Observation { time_us, channel: 0, power_db, occupied });
            }
        }
        summary.finish().swap_remove(0)
    }

    #[test]
    fn occupied_is_the_part_of_the_observations() {
        assert_eq!(summary("xx......").occupied, 0.25);
        assert_eq!(summary("xx......").observations, 8);
        assert_eq!(summary("....").occupied, 0.0);
    }

    #[test]
    fn an_idle_time_lasts_from_the_first_idle_observation_to_the_next_occupied_one() {
        assert_eq!(summary("x....x").mean_idle, 0.4);
        assert_eq!(summary("x....x..x").mean_idle, 0.3);
        assert_eq!(summary("xxx").mean_idle, 0.0);
    }

    #[test]
    fn idle_times_that_were_cut_off_count_as_far_as_they_were_seen() {
        assert_eq!(summary("...........").mean_idle, 1.0);
        assert_eq!(summary("..x...").mean_idle, 0.2);
    }

    #[test]
    fn a_gap_ends_an_idle_time() {
        assert_eq!(summary("x...          ..x").mean_idle, 0.2);
    }

    #[test]
    fn the_mean_power_is_that_of_powers() {
        let expected = 10.0 * 5.5f64.log10();
        assert!((summary("x.").mean_power_db - expected).abs() < 1e-9);
    }

    #[test]
    fn channels_are_apart() {
        let mut summary = Summary::default();
        for channel in [2, 0] {
            summary.add(Observation { time_us: 0, channel, power_db: 0.0, occupied: channel == 2 });
        }
        let channels = summary.finish();
        assert_eq!(channels.iter().map(|it| it.observations).collect::<Vec<_>>(), [1, 0, 1]);
        assert_eq!(channels[2].occupied, 1.0);
        assert_eq!(channels[1], Channel::default());
    }
}
