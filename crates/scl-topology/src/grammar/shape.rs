//! What the value of a key looks like, and its range.

use scl_text::duration::{self, DurationError};
use scl_text::list::{either, listed};
use scl_text::rate::{self, RateError};
use scl_text::size::{self, SizeError};
use std::time::Duration;

/// The form of a value, and its range. The parser rejects values of another form, the checks reject values out of
/// range.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A paragraph.
    Text,
    /// A name.
    Name,
    /// The word of a codec, or a Rust path.
    Codec,
    /// A whole number.
    Number {
        /// The smallest.
        least: u32,
        /// The largest.
        most: u32,
    },
    /// A number and a unit of [`duration`]: at least 1us.
    Duration {
        /// The longest.
        most: Duration,
    },
    /// A number and a unit of [`rate`]: at most 1000 kHz.
    Rate {
        /// The longest time from one to the next.
        longest: Duration,
    },
    /// A whole number and a unit of [`size`]: at least 1 byte.
    Size {
        /// The largest, in bytes.
        most: u64,
    },
    /// `true` or `false`.
    Boolean,
    /// One word of a fixed set.
    Word(&'static [Word]),
    /// A list.
    List(Item),
}

/// A word that an option accepts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Word {
    /// The word as written in the file.
    pub word: &'static str,
    /// What it does, in a few words.
    pub summary: &'static str,
    /// When to choose it: some sentences.
    pub text: &'static str,
}

/// What a list consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Item {
    /// Components.
    Component,
    /// Pairs of gates.
    Connection,
    /// Gates with their names for the outside.
    Export,
    /// Names of files.
    File,
    /// Paths of folders.
    Folder,
    /// Gates.
    Gate,
    /// Kinds of components.
    Kind,
    /// Parameters.
    Parameter,
    /// Gates of every component.
    SharedGate,
    /// Names of other topology files.
    Topology,
}

/// A value that has the right form, but is out of its range.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct OutOfRange {
    /// What the value must be: `at least 1`.
    pub rule: String,
    /// Why a value out of this range cannot work, if there is more to say than the range.
    pub reason: Option<&'static str>,
    /// It is larger than the largest; otherwise it is smaller than the smallest.
    pub is_too_large: bool,
}

impl Shape {
    /// The largest value of a number, a duration or a size.
    pub(crate) fn largest(self) -> Option<String> {
        match self {
            Shape::Number { most, .. } => Some(most.to_string()),
            Shape::Duration { most } => Some(longest(most)),
            Shape::Rate { .. } => Some(HIGHEST_RATE.to_owned()),
            Shape::Size { most } => Some(size::text(most)),
            _ => None,
        }
    }

    /// Describes the form of a value in words that follow `must be`: `a whole number`.
    pub fn rule(self) -> String {
        match self {
            Shape::Text | Shape::Name | Shape::Codec => "text".to_owned(),
            Shape::Number { .. } => "a whole number".to_owned(),
            Shape::Duration { .. } => {
                format!("a number and a unit: {}", either(&duration::UNITS.map(|(unit, _)| unit)))
            }
            Shape::Rate { .. } => format!("a number and a unit: {}", either(&rate::UNITS.map(|(unit, _)| unit))),
            Shape::Size { .. } => format!("a whole number and a unit: {}", either(&size::UNITS.map(|(unit, _)| unit))),
            Shape::Boolean => "`true` or `false`".to_owned(),
            Shape::Word(words) => either(&words.iter().map(|word| word.word).collect::<Vec<_>>()),
            Shape::List(_) => "a list".to_owned(),
        }
    }

    /// Describes the form and the range of a value, for tables: `1 to 1000000`.
    pub fn values(self) -> String {
        match self {
            Shape::Text => "text".to_owned(),
            Shape::Name => "a name".to_owned(),
            Shape::Codec => "a codec or a Rust path".to_owned(),
            Shape::Number { least, most } if least == most => least.to_string(),
            Shape::Number { least, most } => format!("{least} to {most}"),
            Shape::Duration { most } => {
                format!("1us to {} (units: {})", longest(most), listed(duration::UNITS.map(|(unit, _)| unit)))
            }
            Shape::Rate { longest: most } => {
                let units = listed(rate::UNITS.map(|(unit, _)| unit));
                format!("once in {} to {HIGHEST_RATE} (units: {units})", longest(most))
            }
            Shape::Size { most } => {
                format!("1B to {} (units: {})", size::text(most), listed(size::UNITS.map(|(unit, _)| unit)))
            }
            Shape::Boolean => "`true`, `false`".to_owned(),
            Shape::Word(words) => listed(words.iter().map(|word| word.word)),
            Shape::List(Item::Component) => "a list of components".to_owned(),
            Shape::List(Item::Connection) => "a list of pairs".to_owned(),
            Shape::List(Item::Export) => "names, each with a gate".to_owned(),
            Shape::List(Item::File | Item::Topology) => "a list of files".to_owned(),
            Shape::List(Item::Folder) => "a list of folders".to_owned(),
            Shape::List(Item::Gate) => "a list of gates".to_owned(),
            Shape::List(Item::Kind) => "a list of kinds".to_owned(),
            Shape::List(Item::Parameter) => "a list of parameters".to_owned(),
            Shape::List(Item::SharedGate) => "a list of gates with `to`".to_owned(),
        }
    }

    /// Returns true if a scalar has the right form; does not check the range. `is_plain` is true for a scalar without
    /// quotes.
    pub fn fits(self, text: &str, is_plain: bool) -> bool {
        match self {
            Shape::Number { .. } => is_plain && is_whole_number(text),
            Shape::Boolean => is_plain && matches!(text, "true" | "false"),
            Shape::Duration { .. } => duration::parse(text).map_or_else(DurationError::is_out_of_range, |_| true),
            Shape::Rate { .. } => rate::parse(text) != Err(RateError::Malformed),
            Shape::Size { .. } => size::parse(text) != Err(SizeError::Malformed),
            Shape::Word(words) => words.iter().any(|known| known.word == text),
            Shape::Text | Shape::Name | Shape::Codec => true,
            Shape::List(_) => false,
        }
    }
}

/// Returns true for digits with an optional sign. The sign is checked with the range.
pub(crate) fn is_whole_number(text: &str) -> bool {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit())
}

/// Reads a whole number and checks its range.
pub(super) fn number(text: &str, least: u32, most: u32) -> Result<u32, OutOfRange> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    let is_negative = text.starts_with('-') && digits.bytes().any(|digit| digit != b'0');
    // A text of digits fails to parse only by overflow.
    match digits.parse::<u32>() {
        _ if is_negative => Err(below(format!("at least {least}"))),
        Ok(number) if number < least => Err(below(format!("at least {least}"))),
        Ok(number) if number <= most => Ok(number),
        _ => Err(above(format!("at most {most}"))),
    }
}

/// The shortest duration; shorter ones cannot be measured.
const SHORTEST: Duration = Duration::from_micros(1);

/// Reads a duration and checks its range.
pub(super) fn duration(text: &str, most: Duration) -> Result<Duration, OutOfRange> {
    match duration::parse(text) {
        Ok(duration) if (SHORTEST..=most).contains(&duration) => Ok(duration),
        Ok(duration) if duration > most => Err(above(format!("at most {}", longest(most)))),
        Err(DurationError::TooLarge) => Err(above(format!("at most {}", longest(most)))),
        Ok(_) | Err(_) => Err(below("more than 0".to_owned())),
    }
}

/// One message in the [`SHORTEST`] time.
const HIGHEST_RATE: &str = "1000kHz";

/// Reads a rate and checks its range. Returns the time from one to the next.
pub(super) fn rate(text: &str, most: Duration) -> Result<Duration, OutOfRange> {
    match rate::parse(text) {
        Ok(period) if (SHORTEST..=most).contains(&period) => Ok(period),
        Ok(period) if period < SHORTEST => Err(above(format!("at most {HIGHEST_RATE}"))),
        Err(RateError::Malformed | RateError::NotPositive) => Err(below("more than 0".to_owned())),
        Ok(_) | Err(RateError::TooLow) => Err(below(format!("at least once in {}", longest(most)))),
    }
}

/// The longest duration in hours, if it is a whole number of them.
fn longest(most: Duration) -> String {
    match most.as_secs() {
        seconds if seconds > 0 && seconds % 3600 == 0 => format!("{}h", seconds / 3600),
        _ => duration::text(most),
    }
}

/// Reads a number of bytes and checks its range.
pub(super) fn size(text: &str, most: u64) -> Result<u64, OutOfRange> {
    match size::parse(text) {
        Ok(0) | Err(SizeError::Negative | SizeError::Malformed) => Err(OutOfRange {
            rule: "at least 1B".to_owned(),
            reason: Some("a gate with this limit would accept empty messages only"),
            is_too_large: false,
        }),
        Ok(bytes) if bytes <= most => Ok(bytes),
        Ok(_) | Err(SizeError::TooLarge) => Err(OutOfRange {
            rule: format!("at most {}", size::text(most)),
            reason: Some("a message is held in memory as a whole; send larger data in several messages"),
            is_too_large: true,
        }),
    }
}

fn below(rule: String) -> OutOfRange {
    OutOfRange { rule, reason: None, is_too_large: false }
}

fn above(rule: String) -> OutOfRange {
    OutOfRange { rule, reason: None, is_too_large: true }
}

#[cfg(test)]
mod tests {
    use super::{is_whole_number, number};

    #[test]
    fn whole_numbers() {
        for good in ["0", "16", "-1", "+4"] {
            assert!(is_whole_number(good), "{good}");
        }
        for bad in ["", "-", "1.5", "0x10", "1_000", "many", "1e3"] {
            assert!(!is_whole_number(bad), "{bad}");
        }
    }

    #[test]
    fn numbers_have_two_ends() {
        let read = |text| number(text, 1, 9).map_err(|error| error.rule);
        for (text, expected) in [("1", 1), ("+9", 9)] {
            assert_eq!(read(text), Ok(expected));
        }
        for (text, rule) in ["-0", "-5", "0"]
            .map(|text| (text, "at least 1"))
            .into_iter()
            .chain(["10", "99999999999"].map(|text| (text, "at most 9")))
        {
            assert_eq!(read(text), Err(rule.to_owned()), "{text}");
        }
    }
}
