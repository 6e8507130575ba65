//! Durations in messages for people.

use std::fmt;
use std::time::Duration;

/// Shows a duration rounded to three digits: `1.23s` instead of `1.234567891s`.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Rounded(pub(crate) Duration);

impl fmt::Display for Rounded {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let nanos = self.0.as_nanos();
        let digits = nanos.checked_ilog10().map_or(1, |log| log + 1);
        let unit = 10_u128.pow(digits.saturating_sub(3));
        let rounded = (nanos + unit / 2) / unit * unit;
        // Durations of more than 584 years, which overflow 64 bits, are shown unrounded.
        let shown = u64::try_from(rounded).map_or(self.0, Duration::from_nanos);
        write!(f, "{shown:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_are_shown() {
        let cases = [
            (0, "0ns"),
            (7, "7ns"),
            (999, "999ns"),
            (1234, "1.23µs"),
            (45_678, "45.7µs"),
            (999_999, "1ms"),
            (350_449_999, "350ms"),
            (1_234_567_891, "1.23s"),
            (5_000_123_456, "5s"),
            (5_004_999_999, "5s"),
            (5_005_000_000, "5.01s"),
            (123_456_789_012, "123s"),
            (3_600_000_000_000, "3600s"),
        ];
        for (nanos, shown) in cases {
            assert_eq!(Rounded(Duration::from_nanos(nanos)).to_string(), shown);
        }
        assert_eq!(Rounded(Duration::MAX).to_string(), format!("{:?}", Duration::MAX));
    }
}
