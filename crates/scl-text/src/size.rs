//! Sizes in bytes as people write them: a whole number and a unit, for example `512KiB`.

/// The units and their bytes, the smallest first.
pub const UNITS: [(&str, u64); 4] = [("B", 1), ("KiB", 1 << 10), ("MiB", 1 << 20), ("GiB", 1 << 30)];

/// Other spellings of the units in [`UNITS`]; compared in lower case.
const OTHER_UNITS: [(&str, &[&str]); 4] = [
    ("B", &["b", "byte", "bytes"]),
    ("KiB", &["k", "kb", "ki", "kib"]),
    ("MiB", &["m", "mb", "mi", "mib"]),
    ("GiB", &["g", "gb", "gi", "gib"]),
];

/// A number below this, without a unit, is unlikely to be a number of bytes.
const SMALL: u64 = 1024;

/// Why a text is not a size.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SizeError {
    /// Not a whole number and one of [`UNITS`].
    Malformed,
    /// Below zero.
    Negative,
    /// More bytes than 64 bits can count.
    TooLarge,
}

/// Parses a size such as `512KiB` or `8 MiB` into a number of bytes.
///
/// # Errors
///
/// The text is not a whole number and a unit, or is out of the range of `u64`.
pub fn parse(text: &str) -> Result<u64, SizeError> {
    let (number, unit) = split(text);
    let digits = number.strip_prefix(['-', '+']).unwrap_or(number);
    let known = UNITS.iter().find(|(name, _)| *name == unit);
    let Some((_, factor)) = known.filter(|_| is_digits(digits)) else { return Err(SizeError::Malformed) };
    if number.starts_with('-') {
        return Err(SizeError::Negative);
    }
    // Only digits are left, so parsing can fail only by overflow.
    digits.parse::<u64>().ok().and_then(|number| number.checked_mul(*factor)).ok_or(SizeError::TooLarge)
}

/// A number of bytes in the largest unit that divides it: `64MiB`.
pub fn text(bytes: u64) -> String {
    let divides = |factor: u64| bytes != 0 && bytes.is_multiple_of(factor);
    let (unit, factor) = UNITS.into_iter().rev().find(|&(_, factor)| divides(factor)).unwrap_or(UNITS[0]);
    format!("{}{unit}", bytes / factor)
}

/// A number of bytes in the largest unit that it reaches, with about three digits: `6.38GiB`. It is rounded up, so that
/// an upper bound remains one.
pub fn rounded(bytes: u64) -> String {
    let (unit, factor) = UNITS.into_iter().rev().find(|&(_, factor)| bytes >= factor).unwrap_or(UNITS[0]);
    let hundredths = (u128::from(bytes) * 100).div_ceil(factor.into());
    let step = match hundredths {
        ..1000 => 1,
        1000..10_000 => 10,
        _ => 100,
    };
    let hundredths = hundredths.div_ceil(step) * step;
    let number = format!("{}.{:02}", hundredths / 100, hundredths % 100);
    format!("{}{unit}", number.trim_end_matches('0').trim_end_matches('.'))
}

/// The sizes that a malformed text may have meant, the most likely first.
///
/// A number without a unit means bytes, and is also suggested in a larger unit if it is a round number; a small number
/// may be in any unit. Other spellings of a unit, such as `8 mb`, and fractions, such as `1.5MiB`, are rewritten as SCL
/// expects them.
pub fn suggestions(malformed: &str) -> Vec<String> {
    let (number, unit) = split(malformed);
    if unit.is_empty() {
        return number.parse().map(without_unit).unwrap_or_default();
    }
    let unit = unit.to_ascii_lowercase();
    let meant = OTHER_UNITS.iter().find(|(_, others)| others.contains(&unit.as_str()));
    let factor = meant.and_then(|(meant, _)| UNITS.iter().find(|(name, _)| name == meant)).map(|(_, factor)| *factor);
    factor.and_then(|factor| fraction_of(number, factor)).map(text).into_iter().collect()
}

fn without_unit(number: u64) -> Vec<String> {
    let mut texts = match number {
        0 => vec![],
        1..SMALL => vec![format!("{number}MiB"), format!("{number}KiB"), format!("{number}B")],
        _ => vec![format!("{number}B"), text(number)],
    };
    texts.dedup();
    texts
}

/// The bytes of a number with a fraction, if they are a whole number.
fn fraction_of(number: &str, factor: u64) -> Option<u64> {
    let (whole, fraction) = number.split_once('.').unwrap_or((number, "0"));
    if !is_digits(whole) || !is_digits(fraction) {
        return None;
    }
    let parts: u64 = 10_u64.checked_pow(fraction.len().try_into().ok()?)?;
    let product = fraction.parse::<u64>().ok()?.checked_mul(factor)?;
    let bytes = whole.parse::<u64>().ok()?.checked_mul(factor)?.checked_add(product / parts)?;
    product.is_multiple_of(parts).then_some(bytes)
}

/// The number, which may be malformed, and the unit, without the spaces between them.
fn split(text: &str) -> (&str, &str) {
    let (number, unit) = text.split_at(text.find(|letter: char| letter.is_alphabetic()).unwrap_or(text.len()));
    (number.trim(), unit.trim())
}

fn is_digits(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_with_units_are_sizes() {
        let cases = [
            ("1B", 1),
            ("0B", 0),
            ("512KiB", 512 << 10),
            ("8 MiB", 8 << 20),
            ("+1GiB", 1 << 30),
            ("18446744073709551615B", u64::MAX),
        ];
        for (text, bytes) in cases {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
    }

    #[test]
    fn other_texts_are_no_sizes() {
        use SizeError::{Malformed, Negative, TooLarge};
        let cases = [
            ("", Malformed),
            ("65536", Malformed),
            ("MiB", Malformed),
            ("8MB", Malformed),
            ("8mib", Malformed),
            ("1.5MiB", Malformed),
            ("1_000KiB", Malformed),
            ("8MiB8", Malformed),
            ("--1B", Malformed),
            ("-1.5MiB", Malformed),
            ("٣MiB", Malformed),
            ("-1MiB", Negative),
            ("-0B", Negative),
            ("18446744073709551616B", TooLarge),
            ("17179869184GiB", TooLarge),
        ];
        for (text, error) in cases {
            assert_eq!(parse(text), Err(error), "{text}");
        }
    }

    #[test]
    fn the_largest_unit_that_divides_is_written() {
        let cases =
            [(0, "0B"), (1, "1B"), (1025, "1025B"), (1536 << 10, "1536KiB"), (64 << 20, "64MiB"), (1 << 30, "1GiB")];
        for (bytes, expected) in cases {
            assert_eq!(text(bytes), expected);
            assert_eq!(parse(expected), Ok(bytes));
        }
    }

    #[test]
    fn rounded_sizes_are_never_smaller() {
        let cases = [
            (0, "0B"),
            (1023, "1023B"),
            (1024, "1KiB"),
            (1025, "1.01KiB"),
            (64 << 20, "64MiB"),
            ((64 << 20) + 1, "64.1MiB"),
            ((100 << 20) + 1, "101MiB"),
            (1023 << 20, "1023MiB"),
            (6400 << 20, "6.25GiB"),
            (u64::MAX, "17179869184GiB"),
        ];
        for (bytes, expected) in cases {
            assert_eq!(rounded(bytes), expected, "{bytes}");
        }
    }

    #[test]
    fn near_misses_have_suggestions() {
        let cases: [(&str, &[&str]); 17] = [
            ("0", &[]),
            ("65536", &["65536B", "64KiB"]),
            ("1000000", &["1000000B"]),
            ("8", &["8MiB", "8KiB", "8B"]),
            ("8MB", &["8MiB"]),
            ("8 mb", &["8MiB"]),
            ("512kib", &["512KiB"]),
            ("2G", &["2GiB"]),
            ("10 bytes", &["10B"]),
            ("1.5MiB", &["1536KiB"]),
            ("0.5 GB", &["512MiB"]),
            ("0.3KiB", &[]),
            ("1TiB", &[]),
            ("large", &[]),
            ("1.MiB", &[]),
            ("99999999999999999999", &[]),
            ("1.99999999999999999999MiB", &[]),
        ];
        for (text, expected) in cases {
            assert_eq!(suggestions(text), expected, "{text}");
            assert!(suggestions(text).iter().all(|size| parse(size).is_ok()), "{text}");
        }
    }
}
