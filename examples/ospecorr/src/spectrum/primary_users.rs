//! When primary users transmit: as scheduled, or at random.

use std::str::FromStr;
use std::time::Duration;

use rand::rngs::StdRng;
use rand_distr::{Distribution, Exp1};

use super::random::{self, Purpose};
use crate::band::CHANNELS;

/// Mean time for which a random primary user is away.
const MEAN_IDLE_US: f64 = 6e6;
/// Mean time for which a random primary user then transmits, so that each channel is in use two fifths of the time.
const MEAN_VISIT_US: f64 = 4e6;

/// The time during which a primary user transmits in a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Visit {
    channel: u32,
    from_us: u64,
    to_us: u64,
}

impl Visit {
    fn overlaps(&self, from_us: u64, to_us: u64) -> bool {
        self.from_us < to_us && from_us < self.to_us
    }
}

/// Parses `CHANNEL@FROM..TO`, with times in seconds.
impl FromStr for Visit {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let parts = text.split_once('@').and_then(|(channel, times)| Some((channel, times.split_once("..")?)));
        let Some((channel, (from, to))) = parts else {
            return Err("write CHANNEL@FROM..TO with times in seconds, like 3@5..12.5".to_owned());
        };
        let channel = channel.parse().ok().filter(|it| *it < CHANNELS);
        let channel = channel.ok_or_else(|| format!("the channels are 0 to {}", CHANNELS - 1))?;
        let (from_us, to_us) = (microseconds(from)?, microseconds(to)?);
        if from_us >= to_us {
            return Err(format!("{from} s is not before {to} s"));
        }
        Ok(Self { channel, from_us, to_us })
    }
}

fn microseconds(seconds: &str) -> Result<u64, String> {
    let time = seconds.parse().ok().and_then(|it| Duration::try_from_secs_f64(it).ok());
    let time = time.and_then(|it| u64::try_from(it.as_micros()).ok());
    time.ok_or_else(|| format!("`{seconds}` is not a time in seconds"))
}

/// All primary users of the band.
pub enum PrimaryUsers {
    /// Users that transmit at these times.
    Scheduled(Vec<Visit>),
    /// A user in each channel, independent of the others.
    Random(Vec<RandomUser>),
}

impl PrimaryUsers {
    /// Random visits in every channel; the same `seed` gives the same visits.
    pub fn random(seed: u64) -> Self {
        Self::Random((0..CHANNELS).map(|channel| RandomUser::new(channel, seed)).collect())
    }

    /// Returns the channels that are in use at some time from `from_us` until before `to_us`, in order. The times must
    /// not decrease from call to call.
    pub fn channels(&mut self, from_us: u64, to_us: u64) -> Vec<u32> {
        (0..CHANNELS).filter(|channel| self.uses(*channel, from_us, to_us)).collect()
    }

    fn uses(&mut self, channel: u32, from_us: u64, to_us: u64) -> bool {
        match self {
            Self::Scheduled(visits) => visits.iter().any(|it| it.channel == channel && it.overlaps(from_us, to_us)),
            Self::Random(users) => users[channel as usize].current(from_us).overlaps(from_us, to_us),
        }
    }
}

/// A primary user that comes and goes after exponentially distributed times: an alternating renewal process, as in Kim
/// and Shin, "Efficient Discovery of Spectrum Opportunities", IEEE Transactions on Mobile Computing 7(5), 2008.
pub struct RandomUser {
    rng: StdRng,
    visit: Visit,
}

impl RandomUser {
    fn new(channel: u32, seed: u64) -> Self {
        Self {
            rng: random::generator(seed, Purpose::PrimaryUser(channel)),
            visit: Visit { channel, from_us: 0, to_us: 0 },
        }
    }

    /// The first visit that is not over at a time.
    fn current(&mut self, time_us: u64) -> Visit {
        while self.visit.to_us <= time_us {
            self.visit.from_us = self.visit.to_us + self.exponential_us(MEAN_IDLE_US);
            self.visit.to_us = self.visit.from_us + self.exponential_us(MEAN_VISIT_US);
        }
        self.visit
    }

    fn exponential_us(&mut self, mean_us: f64) -> u64 {
        let drawn: f64 = Exp1.sample(&mut self.rng);
        1 + (drawn * mean_us) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_visit_is_read() {
        assert_eq!("3@5..12.5".parse(), Ok(Visit { channel: 3, from_us: 5_000_000, to_us: 12_500_000 }));
    }

    #[test]
    fn mistakes_in_a_visit_are_explained() {
        for (text, expected) in [
            ("3", "write CHANNEL@FROM..TO with times in seconds, like 3@5..12.5"),
            ("3@5", "write CHANNEL@FROM..TO with times in seconds, like 3@5..12.5"),
            ("8@5..12", "the channels are 0 to 7"),
            ("-1@5..12", "the channels are 0 to 7"),
            ("3@five..12", "`five` is not a time in seconds"),
            ("3@-1..12", "`-1` is not a time in seconds"),
            ("3@5..inf", "`inf` is not a time in seconds"),
            ("3@12..5", "12 s is not before 5 s"),
        ] {
            assert_eq!(text.parse::<Visit>(), Err(expected.to_owned()), "{text}");
        }
    }

    #[test]
    fn scheduled_users_are_there_from_the_beginning_to_the_end_of_a_visit() {
        let mut users = PrimaryUsers::Scheduled(vec!["5@1..2".parse().unwrap(), "2@1.5..3".parse().unwrap()]);
        assert!(users.channels(999_999, 1_000_000).is_empty());
        assert_eq!(users.channels(999_999, 1_000_001), [5]);
        assert_eq!(users.channels(1_600_000, 1_600_001), [2, 5]);
        assert_eq!(users.channels(2_000_000, 2_000_001), [2]);
    }

    #[test]
    fn random_users_transmit_two_fifths_of_the_time_and_each_on_their_own() {
        let mut users = PrimaryUsers::random(1);
        let mut counts = [0u32; CHANNELS as usize];
        let seconds = 20_000;
        let mut both = 0;
        for second in 0..seconds {
            let channels = users.channels(second * 1_000_000, second * 1_000_000 + 1);
            both += u64::from(channels.contains(&0) && channels.contains(&1));
            for channel in channels {
                counts[channel as usize] += 1;
            }
        }
        for count in counts {
            // 2000 visits each: the part has a standard deviation of about 0.01.
            assert!((f64::from(count) / seconds as f64 - 0.4).abs() < 0.04, "{counts:?}");
        }
        assert!((both as f64 / seconds as f64 - 0.16).abs() < 0.03, "{both}");
    }

    #[test]
    fn a_seed_gives_the_same_visits() {
        let visits = |seed| {
            let mut users = PrimaryUsers::random(seed);
            (0..1000).map(|it| users.channels(it * 100_000, it * 100_000 + 1)).collect::<Vec<_>>()
        };
        assert_eq!(visits(1), visits(1));
        assert_ne!(visits(1), visits(2));
    }
}
