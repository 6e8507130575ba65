//! Durations as people write them: a number, perhaps with a fraction, and a unit, for example `1.5s`.

use std::time::Duration;

/// The units, each with its seconds, the smallest first.
pub const UNITS: [(&str, f64); 3] = [("us", 1e-6), ("ms", 1e-3), ("s", 1.0)];

/// Why a text is not a duration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DurationError {
    /// Not a number and one of [`UNITS`].
    Malformed,
    /// Below zero, or less than a microsecond, which cannot be measured.
    TooSmall,
    /// More seconds than 64 bits can count.
    TooLarge,
}

/// The duration that a text such as `500ms` or `1.5 s` means.
///
/// # Errors
///
/// The text is not a number and a unit, or is out of the range of [`Duration`].
pub fn parse(text: &str) -> Result<Duration, DurationError> {
    let Some((number, seconds)) = split(text) else { return Err(DurationError::Malformed) };
    let digits = number.strip_prefix(['-', '+']).unwrap_or(number);
    let (whole, fraction) = digits.split_once('.').unwrap_or((digits, "0"));
    if ![whole, fraction].iter().all(|part| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit())) {
        return Err(DurationError::Malformed);
    }
    let number: f64 = number.parse().map_err(|_| DurationError::Malformed)?;
    if number * seconds < UNITS[0].1 {
        return Err(DurationError::TooSmall);
    }
    Duration::try_from_secs_f64(number * seconds).map_err(|_| DurationError::TooLarge)
}

/// A duration in the largest unit in which it is a whole number: `1500ms`. Parts of a microsecond are left out.
pub fn text(duration: Duration) -> String {
    let microseconds = duration.as_micros();
    let (factor, unit) = match microseconds {
        whole if whole % 1_000_000 == 0 => (1_000_000, "s"),
        whole if whole % 1_000 == 0 => (1_000, "ms"),
        _ => (1, "us"),
    };
    format!("{}{unit}", microseconds / factor)
}

/// The number, which may be malformed, and the seconds of the unit.
fn split(text: &str) -> Option<(&str, f64)> {
    UNITS.iter().find_map(|(unit, seconds)| text.strip_suffix(unit).map(|number| (number.trim_end(), *seconds)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units_are_durations() {
        let cases =
            [("500ms", 500_000), ("1s", 1_000_000), ("1.5 s", 1_500_000), ("20us", 20), ("+1ms", 1_000), ("1us", 1)];
        for (text, microseconds) in cases {
            assert_eq!(parse(text), Ok(Duration::from_micros(microseconds)), "{text}");
        }
    }

    #[test]
    fn other_texts_are_no_durations() {
        use DurationError::{Malformed, TooLarge, TooSmall};
        for text in ["", "s", "500", "1 min", "ms500", "1.s", ".5s", "1h", "1 000ms", "1e3s", "--1s"] {
            assert_eq!(parse(text), Err(Malformed), "{text}");
        }
        for text in ["0s", "-1s", "0.5us", "-0ms"] {
            assert_eq!(parse(text), Err(TooSmall), "{text}");
        }
        assert_eq!(parse("99999999999999999999999s"), Err(TooLarge));
    }

    #[test]
    fn the_largest_unit_that_divides_is_written() {
        for (microseconds, expected) in [(0, "0s"), (1, "1us"), (500_000, "500ms"), (1_500_000, "1500ms")] {
            assert_eq!(text(Duration::from_micros(microseconds)), expected);
        }
    }
}
