//! Rates as people write them: a number, perhaps with a fraction, and a unit, for example `100Hz`.

use crate::{duration, number};
use std::time::Duration;

/// In nanoseconds.
const SECOND: u128 = 1_000_000_000;

/// The units, each with its messages per second, the smallest first.
pub const UNITS: [(&str, f64); 2] = [("Hz", 1.0), ("kHz", 1e3)];

/// Why a text is not a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RateError {
    /// It is not a number and one of the [`UNITS`].
    Malformed,
    /// Zero, or below.
    NotPositive,
    /// Less than once in 584 years.
    TooLow,
}

/// Parses a rate such as `100Hz` or `0.5 Hz`. Returns the time from one to the next, rounded to nanoseconds.
///
/// ```
/// use scl_text::rate::parse;
/// use std::time::Duration;
///
/// assert_eq!(parse("100Hz"), Ok(Duration::from_millis(10)));
/// ```
///
/// # Errors
///
/// The text is not a number and a unit, or the rate is not above zero.
pub fn parse(text: &str) -> Result<Duration, RateError> {
    let (number, unit) = number::split(text);
    let number = number::decimal(number).ok_or(RateError::Malformed)?;
    let (_, factor) = UNITS.iter().find(|(word, _)| *word == unit).ok_or(RateError::Malformed)?;
    if number <= 0.0 {
        return Err(RateError::NotPositive);
    }
    let nanoseconds = (1e9 / (number * factor)).round();
    // The result is not negative, and a larger one than fits becomes the largest.
    match nanoseconds as u64 {
        u64::MAX => Err(RateError::TooLow),
        nanoseconds => Ok(Duration::from_nanos(nanoseconds)),
    }
}

/// The rate that a text in another spelling probably means: `100 hz`, or a number alone.
pub fn meant(text: &str) -> Option<String> {
    let (number, unit) = number::split(text);
    let unit = match unit.trim().to_lowercase().as_str() {
        "" | "hz" | "hertz" | "fps" | "sps" => "Hz",
        "khz" | "k" => "kHz",
        _ => return None,
    };
    let rate = format!("{number}{unit}");
    parse(&rate).is_ok().then_some(rate)
}

/// The time from one to the next that a rate means, in whatever spelling, but with its unit: of `20 hz`, 50 ms.
pub fn period(text: &str) -> Option<Duration> {
    let rate = meant(text).filter(|_| text.trim_end().to_lowercase().ends_with("hz"))?;
    parse(&rate).ok().filter(|period| !period.is_zero())
}

/// The rate of what happens once in a duration, if it is a whole number of Hz: of `10ms`, `100Hz`.
pub fn of_period(duration: &str) -> Option<String> {
    let nanoseconds = duration::parse(duration).ok()?.as_nanos();
    let is_whole = nanoseconds > 0 && SECOND.is_multiple_of(nanoseconds);
    is_whole.then(|| format!("{}Hz", SECOND / nanoseconds))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rate_is_a_time_between_two() {
        let cases = [("100Hz", 10_000_000), ("300Hz", 3_333_333), ("0.5 Hz", 2_000_000_000), ("1kHz", 1_000_000)];
        for (text, nanoseconds) in cases {
            assert_eq!(parse(text), Ok(Duration::from_nanos(nanoseconds)), "{text}");
        }
    }

    #[test]
    fn other_texts_are_no_rates() {
        use RateError::{Malformed, NotPositive, TooLow};
        let cases: [(RateError, &[&str]); 3] = [
            (Malformed, &["", "100", "Hz", "100 per second", "1e3Hz", "100hz", "100ms", "1.2.3Hz"]),
            (NotPositive, &["0Hz", "-5Hz"]),
            (TooLow, &["0.00000000000000001Hz"]),
        ];
        for (error, texts) in cases {
            for text in texts {
                assert_eq!(parse(text), Err(error), "{text}");
            }
        }
    }

    #[test]
    fn other_spellings_are_understood() {
        let cases =
            [("100", Some("100Hz")), ("100 hz", Some("100Hz")), ("2KHZ", Some("2kHz")), ("30fps", Some("30Hz"))];
        for (text, rate) in cases {
            assert_eq!(meant(text).as_deref(), rate, "{text}");
        }
        for text in ["fast", "100ms", "0"] {
            assert_eq!(meant(text), None, "{text}");
        }
    }

    #[test]
    fn rates_and_periods_mean_each_other() {
        for (text, milliseconds) in [("20Hz", 50), ("20 hz", 50), ("1KHZ", 1)] {
            assert_eq!(period(text), Some(Duration::from_millis(milliseconds)), "{text}");
        }
        for text in ["20", "fast", "0Hz", "50ms", ""] {
            assert_eq!(period(text), None, "{text}");
        }
        assert_eq!(["10ms", "1us", "1 s"].map(of_period), ["100Hz", "1000000Hz", "1Hz"].map(|it| Some(it.to_owned())));
        assert_eq!(["3ms", "2s", "0s", "100Hz", "10"].map(of_period), [None, None, None, None, None]);
    }
}
