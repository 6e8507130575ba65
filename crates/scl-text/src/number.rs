//! A decimal number and a unit.

/// The number, which may be malformed, and the unit, without the spaces between them.
pub(crate) fn split(text: &str) -> (&str, &str) {
    let (number, unit) = text.split_at(text.find(|letter: char| letter.is_alphabetic()).unwrap_or(text.len()));
    (number.trim(), unit)
}

/// Reads a decimal number, perhaps with a sign and a fraction.
pub(crate) fn decimal(number: &str) -> Option<f64> {
    let digits = number.strip_prefix(['-', '+']).unwrap_or(number);
    // `parse` also accepts exponents, `inf` and `nan`.
    let is_decimal = digits.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    number.parse().ok().filter(|_| is_decimal)
}
