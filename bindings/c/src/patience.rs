//! The time limit of a receiving call that continues after an undecodable message was skipped.

use crate::border::Wait;
use std::time::{Duration, Instant};

/// As a timeout of scl_recv and scl_take_request: what is left of the timeout of the previous call. For code that goes
/// on after scl_undecodable.
pub const SCL_REST: i64 = -9223372036854775807;

/// How long a call that does not wait may be held up by undecodable messages.
const LONGEST_SKIP: Duration = Duration::from_millis(10);

/// The timeout of the last receiving call of a gate.
pub(crate) struct Patience {
    wait: Wait,
    /// When the call began; for a call that does not wait, when it skipped its first message.
    began: Option<Instant>,
}

impl Patience {
    pub(crate) const NONE: Self = Self { wait: Wait::No, began: None };

    /// Returns how long a receiving call with this timeout waits, or `None` if undecodable messages have held it up for
    /// too long.
    pub(crate) fn of(&mut self, timeout_ns: i64) -> Option<Wait> {
        if timeout_ns != SCL_REST {
            self.wait = Wait::of(timeout_ns);
            self.began = matches!(self.wait, Wait::For(_)).then(Instant::now);
            return Some(self.wait);
        }
        let waited = self.began.get_or_insert_with(Instant::now).elapsed();
        match self.wait {
            Wait::No => (waited < LONGEST_SKIP).then_some(Wait::No),
            Wait::For(limit) => Some(Wait::For(limit.saturating_sub(waited))),
            Wait::Forever => Some(Wait::Forever),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rest_is_never_more_than_the_timeout() {
        let mut patience = Patience::NONE;
        assert_eq!(patience.of(-1), Some(Wait::Forever));
        assert_eq!(patience.of(SCL_REST), Some(Wait::Forever));
        assert_eq!(patience.of(1), Some(Wait::For(Duration::from_nanos(1))));
        assert!(matches!(patience.of(SCL_REST), Some(Wait::For(rest)) if rest <= Duration::from_nanos(1)));
        assert_eq!(patience.of(0), Some(Wait::No));
        while patience.of(SCL_REST).is_some() {}
        assert_eq!(patience.of(0), Some(Wait::No));
    }
}
