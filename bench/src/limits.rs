//! The values that the options of `scl bench` accept. An error says what to write instead.

use scl_text::duration::parse_duration;
use std::ops::RangeInclusive;
use std::time::Duration;

/// The accepted numbers of messages: the times of ten million messages briefly take 800 MB.
pub(crate) const MESSAGES: RangeInclusive<usize> = 1..=10_000_000;

pub(crate) const REPETITIONS: RangeInclusive<usize> = 1..=10_000;

/// Parses a whole number within a range.
pub(crate) fn within(range: RangeInclusive<usize>) -> impl Fn(&str) -> Result<usize, String> + Clone {
    move |text| match text.trim().parse() {
        Ok(number) if range.contains(&number) => Ok(number),
        _ => Err(format!("write a whole number from {} to {}", range.start(), range.end())),
    }
}

/// Parses `5` or `0.5`, or a number with a unit, `5s`.
pub(crate) fn parse_seconds(text: &str) -> Result<Duration, String> {
    let with_unit = if text.ends_with(|c: char| c.is_ascii_digit()) { format!("{text}s") } else { text.to_owned() };
    let expected = || "write a time from 0.001 to 3600 seconds, like `5` or `500ms`".to_owned();
    let time = parse_duration(&with_unit).map_err(|_| expected())?;
    if time < Duration::from_millis(1) || time > Duration::from_secs(3600) {
        return Err(expected());
    }
    Ok(time)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_may_have_a_unit() {
        for (text, milliseconds) in [("5", 5_000), ("0.5", 500), ("250ms", 250), ("1h", 3_600_000)] {
            assert_eq!(parse_seconds(text), Ok(Duration::from_millis(milliseconds)), "{text}");
        }
        for text in ["0", "-1", "2h", "five", "", "5 days", "0.0009"] {
            let expected = Err("write a time from 0.001 to 3600 seconds, like `5` or `500ms`".to_owned());
            assert_eq!(parse_seconds(text), expected, "{text}");
        }
    }

    #[test]
    fn numbers_must_be_in_their_range() {
        let parse = within(8..=1024);
        for (text, number) in [("8", 8), ("1024", 1024), (" 20", 20)] {
            assert_eq!(parse(text), Ok(number), "{text}");
        }
        for text in ["7", "1025", "-1", "1e3", "many", "", "99999999999999999999999999"] {
            assert_eq!(parse(text), Err("write a whole number from 8 to 1024".to_owned()), "{text}");
        }
    }
}
