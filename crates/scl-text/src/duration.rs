//! Durations as people write them: a number, perhaps with a fraction, and a unit, for example `1.5s`.

use crate::number::{decimal, split};
use std::time::Duration;

/// The units, each with its seconds, the smallest first.
pub const UNITS: [(&str, f64); 6] = [("us", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("m", 60.0), ("h", 3600.0)];

/// Each unit in the words of people and of other formats.
const SPELLINGS: [(&str, &str); 5] = [
    ("us", "us µs μs usec usecs micros microsec microsecond microseconds"),
    ("ms", "ms msec msecs millis millisec millisecond milliseconds"),
    ("s", "s sec secs second seconds"),
    ("min", "m min mins minute minutes"),
    ("h", "h hr hrs hour hours"),
];

/// The unit that a word in lower case probably means: `us`, `ms`, `s`, `min` or `h`.
pub fn unit(word: &str) -> Option<&'static str> {
    SPELLINGS.iter().find(|(_, words)| words.split(' ').any(|other| other == word)).map(|(unit, _)| *unit)
}

/// Why a text is not a duration.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum DurationError {
    /// It does not begin with a number.
    NoNumber,
    /// It is a number without a unit.
    NoUnit,
    /// The unit is not one of [`UNITS`].
    UnknownUnit,
    /// Below zero.
    Negative,
    /// More seconds than 64 bits can count.
    TooLarge,
}

impl DurationError {
    /// Whether the text is a number and a unit, and only its value cannot be used.
    pub fn is_out_of_range(self) -> bool {
        matches!(self, DurationError::Negative | DurationError::TooLarge)
    }
}

/// Parses a duration such as `500ms`, `1.5 s` or `2min`.
///
/// # Errors
///
/// The text is not a number and a unit, or is out of the range of [`Duration`].
pub fn parse(text: &str) -> Result<Duration, DurationError> {
    let (number, unit) = split(text);
    let number = decimal(number).ok_or(DurationError::NoNumber)?;
    let seconds = match UNITS.iter().find(|(word, _)| *word == unit) {
        Some((_, seconds)) => number * seconds,
        None if unit.is_empty() => return Err(DurationError::NoUnit),
        None => return Err(DurationError::UnknownUnit),
    };
    if seconds < 0.0 {
        return Err(DurationError::Negative);
    }
    Duration::try_from_secs_f64(seconds).map_err(|_| DurationError::TooLarge)
}

/// [`parse`] for values of options and keys, with the problem as a sentence.
///
/// # Errors
///
/// What is missing or wrong, for the user.
pub fn parse_duration(text: &str) -> Result<Duration, String> {
    parse(text).map_err(|error| match error {
        DurationError::NoNumber => "expected a number and a unit, like `5s`".to_owned(),
        DurationError::NoUnit => format!("the unit is missing: write `{text}s` or `{text}ms`"),
        DurationError::UnknownUnit => {
            format!("unknown unit `{}`; the units are {}", split(text).1, UNITS.map(|(unit, _)| unit).join(", "))
        }
        DurationError::Negative => format!("`{text}` is negative"),
        DurationError::TooLarge => format!("`{text}` is too long"),
    })
}

/// Nanoseconds for files and messages. A duration that does not fit, of more than 584 years, is the longest one.
pub fn nanoseconds(duration: Duration) -> u64 {
    u64::try_from(duration.as_nanos()).unwrap_or(u64::MAX)
}

/// A duration in the largest unit up to seconds in which it is a whole number: `1500ms`. Parts of a microsecond are
/// left out.
pub fn text(duration: Duration) -> String {
    let microseconds = duration.as_micros();
    let (factor, unit) = match microseconds {
        whole if whole % 1_000_000 == 0 => (1_000_000, "s"),
        whole if whole % 1_000 == 0 => (1_000, "ms"),
        _ => (1, "us"),
    };
    format!("{}{unit}", microseconds / factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units_are_durations() {
        let cases = [
            ("500ms", 500_000),
            ("1s", 1_000_000),
            ("1.5 s", 1_500_000),
            (" 1s", 1_000_000),
            ("1.s", 1_000_000),
            (".5s", 500_000),
            ("20us", 20),
            ("+1ms", 1_000),
            ("1us", 1),
            ("0s", 0),
            ("-0ms", 0),
            ("1.5min", 90_000_000),
            ("1m", 60_000_000),
            ("1 min", 60_000_000),
            ("1h", 3_600_000_000),
        ];
        for (text, microseconds) in cases {
            assert_eq!(parse(text), Ok(Duration::from_micros(microseconds)), "{text}");
        }
        assert_eq!(parse("0.5us"), Ok(Duration::from_nanos(500)));
    }

    #[test]
    fn other_texts_are_no_durations() {
        use DurationError::{Negative, NoNumber, NoUnit, TooLarge, UnknownUnit};
        let cases: [(DurationError, &[&str]); 5] = [
            (NoNumber, &["", "s", "ms500", ".s", "1.2.3s", "1 000ms", "--1s", "infs", "1_000ms", "٣s"]),
            (NoUnit, &["500", "5 "]),
            (UnknownUnit, &["5 days", "1e3s", "1S", "1s ", "1sec"]),
            (Negative, &["-1s", "-0.5us"]),
            (TooLarge, &["99999999999999999999999s"]),
        ];
        for (error, texts) in cases {
            for text in texts {
                assert_eq!(parse(text), Err(error), "{text}");
            }
        }
    }

    #[test]
    fn errors_say_what_is_missing() {
        let cases = [
            ("5", "the unit is missing: write `5s` or `5ms`"),
            ("s", "expected a number and a unit, like `5s`"),
            ("", "expected a number and a unit, like `5s`"),
            ("5 days", "unknown unit `days`; the units are us, ms, s, min, m, h"),
            ("-5s", "`-5s` is negative"),
            ("9999999999999999999999999h", "`9999999999999999999999999h` is too long"),
        ];
        for (text, expected) in cases {
            assert_eq!(parse_duration(text), Err(expected.to_owned()), "{text}");
        }
    }

    #[test]
    fn the_largest_unit_that_divides_is_written() {
        for (microseconds, expected) in [(0, "0s"), (1, "1us"), (500_000, "500ms"), (1_500_000, "1500ms")] {
            assert_eq!(text(Duration::from_micros(microseconds)), expected);
        }
    }
}
