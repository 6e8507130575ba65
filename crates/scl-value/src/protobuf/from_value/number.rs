//! Numbers of a type from values, without loss.

use super::wrong;
use crate::error::Mismatch;
use crate::value::Value;

/// Reads a floating-point number; `word` names its type.
pub(super) fn float(value: &Value, word: &str) -> Result<f64, Mismatch> {
    let wrong = || wrong(&format!("a number ({word})"), value);
    let number = match value {
        Value::Written(written) => match &written.meaning {
            Value::Text(text) => return Err(leading_zeros(text, wrong())),
            meaning => return float(meaning, word),
        },
        Value::Float(number) => Some(*number),
        Value::Int(number) => Some(*number as f64),
        Value::Uint(number) => Some(*number as f64),
        // As in protobuf's JSON.
        Value::Text(text) => match text.as_str() {
            "NaN" => Some(f64::NAN),
            "Infinity" => Some(f64::INFINITY),
            "-Infinity" => Some(f64::NEG_INFINITY),
            text => text.parse().ok().filter(|number: &f64| number.is_finite()),
        },
        _ => None,
    };
    number.ok_or_else(wrong)
}

/// Reads a whole number of the type `N`, which `word` names.
pub(super) fn integer<N>(value: &Value, word: &str, least: N, most: N) -> Result<N, Mismatch>
where
    N: TryFrom<i128> + std::fmt::Display,
{
    let wrong = || wrong(&format!("a whole number from {least} to {most} ({word})"), value);
    let number = match value {
        Value::Written(written) => match &written.meaning {
            Value::Text(text) => return Err(leading_zeros(text, wrong())),
            // A float is exact up to 2^53 only.
            Value::Float(_) => whole_number(&written.text),
            meaning => return integer(meaning, word, least, most),
        },
        Value::Int(number) => Some(i128::from(*number)),
        Value::Uint(number) => Some(i128::from(*number)),
        Value::Float(number) if number.fract() == 0.0 && number.abs() < 2_f64.powi(64) => Some(*number as i128),
        Value::Text(text) => text.parse().ok(),
        _ => None,
    };
    let fitting = number.and_then(|number| N::try_from(number).ok());
    fitting.ok_or_else(wrong)
}

/// The exact value of a decimal number, if it is whole: `-1.5e3`.
fn whole_number(text: &str) -> Option<i128> {
    let (number, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
    let (whole, fraction) = number.split_once('.').unwrap_or((number, ""));
    let exponent: i32 = exponent.parse().ok().filter(|exponent: &i32| exponent.abs() < 100)?;
    let digits = format!("{whole}{fraction}");
    let scale = exponent - i32::try_from(fraction.len()).ok()?;
    let digits = match usize::try_from(scale) {
        Ok(zeros) => format!("{digits}{}", "0".repeat(zeros)),
        Err(_) => {
            let cut = digits.len().checked_sub(scale.unsigned_abs() as usize)?;
            let rest = digits.get(cut..)?;
            rest.bytes().all(|digit| digit == b'0').then(|| digits[..cut].to_owned())?
        }
    };
    digits.parse().ok()
}

/// Adds to an error a hint on how to write a number with leading zeros, which is octal in YAML 1.1 and decimal in YAML
/// 1.2.
fn leading_zeros(text: &str, error: Mismatch) -> Mismatch {
    let (sign, digits) = text.split_at(text.len() - text.trim_start_matches(['-', '+']).len());
    let plain = digits.trim_start_matches('0');
    let plain = if plain.starts_with(|first: char| first.is_ascii_digit()) { plain } else { &format!("0{plain}") };
    let is_octal = digits.bytes().all(|digit| (b'0'..b'8').contains(&digit));
    match is_octal && plain != "0" {
        true => error.help(format!("write `{sign}{plain}`, or `{sign}0o{plain}` for an octal number")),
        false => error.help(format!("write `{sign}{plain}`")),
    }
}

#[cfg(test)]
mod tests {
    use super::whole_number;

    #[test]
    fn whole_numbers_are_exact() {
        for (text, expected) in [
            ("9007199254740993.0", Some(9_007_199_254_740_993)),
            ("-9223372036854775809", Some(-9_223_372_036_854_775_809)),
            ("1e3", Some(1_000)),
            ("+1.5E1", Some(15)),
            ("1200e-2", Some(12)),
            ("-0.0", Some(0)),
            ("1.000000000000000000001", None),
            ("15e-1", None),
            ("1e99", None),
            ("1e999999999", None),
            (".5e1", Some(5)),
            ("5.", Some(5)),
            (".", None),
            ("1e", None),
            ("0x10", None),
            ("\u{e4}.0", None),
        ] {
            assert_eq!(whole_number(text), expected, "{text}");
        }
    }
}
