//! Durations on the command line: a number and a unit, as in the topology file.

use std::time::Duration;

const UNITS: [(&str, f64); 6] = [("us", 1e-6), ("ms", 1e-3), ("s", 1.0), ("min", 60.0), ("m", 60.0), ("h", 3600.0)];

/// Reads `500ms`, `5s`, `1.5min`.
///
/// # Errors
///
/// A text for the user when the number or the unit is missing, unknown, negative or too large.
pub fn parse_duration(text: &str) -> Result<Duration, String> {
    let unit_start = text.find(|c: char| c.is_ascii_alphabetic()).unwrap_or(text.len());
    let (number, unit) = text.split_at(unit_start);
    let number: f64 = number.trim().parse().map_err(|_| format!("expected a number and a unit, like `{EXAMPLE}`"))?;
    let Some((_, seconds)) = UNITS.iter().find(|(word, _)| *word == unit) else {
        return Err(match unit {
            "" => format!("the unit is missing: write `{text}s` or `{text}ms`"),
            _ => format!("unknown unit `{unit}`; the units are us, ms, s, min, h"),
        });
    };
    Duration::try_from_secs_f64(number * seconds).map_err(|_| format!("`{text}` is not a usable duration"))
}

const EXAMPLE: &str = "5s";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units_are_durations() {
        for (text, milliseconds) in
            [("5s", 5_000), ("500ms", 500), ("1.5min", 90_000), ("1m", 60_000), ("0s", 0), ("1h", 3_600_000)]
        {
            assert_eq!(parse_duration(text), Ok(Duration::from_millis(milliseconds)), "{text}");
        }
    }

    #[test]
    fn anything_else_says_what_is_missing() {
        let cases = [
            ("5", "the unit is missing: write `5s` or `5ms`"),
            ("s", "expected a number and a unit, like `5s`"),
            ("", "expected a number and a unit, like `5s`"),
            ("5 days", "unknown unit `days`; the units are us, ms, s, min, h"),
            ("-5s", "`-5s` is not a usable duration"),
            ("9999999999999999999999999h", "`9999999999999999999999999h` is not a usable duration"),
        ];
        for (text, expected) in cases {
            assert_eq!(parse_duration(text), Err(expected.to_owned()), "{text}");
        }
    }
}
