//! How many handshakes each address may begin in a second.

use crate::source::Source;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Handshakes that an address may begin at once: no more hosts than that share one address.
const BURST: u32 = 256;
/// The time after which an address may begin one more. A handshake takes a few tenths of a millisecond of CPU time, and
/// a host tries four times per second.
const REFILL: Duration = Duration::from_millis(10);
/// Maximum number of addresses that are remembered. Beyond that, all start afresh.
const MOST: usize = 4096;

/// A token bucket for each address.
#[derive(Default)]
pub(crate) struct Rates {
    /// When the bucket of an address is full again; later than now by [`REFILL`] for each handshake.
    full_at: HashMap<Source, Instant>,
}

impl Rates {
    /// Takes a token of the address. Returns false if it has none left and must wait.
    pub(crate) fn take(&mut self, source: Source) -> bool {
        self.take_at(source, Instant::now())
    }

    fn take_at(&mut self, source: Source, now: Instant) -> bool {
        if self.full_at.len() >= MOST {
            self.full_at.retain(|_, full_at| *full_at > now);
        }
        if self.full_at.len() >= MOST {
            self.full_at.clear();
        }
        let full_at = self.full_at.entry(source).or_insert(now);
        let next = (*full_at).max(now) + REFILL;
        let has_token = next <= now + REFILL * BURST;
        if has_token {
            *full_at = next;
        }
        has_token
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn source(last: u32) -> Source {
        Source::of(std::net::Ipv4Addr::from_bits(last).into())
    }

    #[test]
    fn an_address_has_a_burst_and_then_a_rate_of_its_own() {
        let (mut rates, now) = (Rates::default(), Instant::now());
        let mut begun = |source, now| (0..1000).filter(|_| rates.take_at(source, now)).count();
        assert_eq!(begun(source(1), now), 256);
        assert_eq!(begun(source(2), now), 256);
        assert_eq!(begun(source(1), now + REFILL * 7), 7);
        assert_eq!(begun(source(1), now + REFILL * 1000), 256);
    }

    #[test]
    fn many_addresses_take_limited_memory() {
        let (mut rates, now) = (Rates::default(), Instant::now());
        assert!((0..100_000).all(|last| rates.take_at(source(last), now)));
        assert!(rates.full_at.len() <= MOST);
    }
}
