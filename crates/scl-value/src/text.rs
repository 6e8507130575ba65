//! Values as texts: YAML and rows of a table.

mod as_written;
mod documents;
mod table;
mod yaml;

pub use documents::Documents;
pub use table::Table;
pub use yaml::{ReadError, read_yaml, to_yaml};

use crate::error::Mismatch;
use crate::value::{Value, key_text};
use scl_text::excerpt::excerpt;

/// Returns the bytes of an opaque message, which is given as bytes, or as a map with `hex` or `text`, whose values are
/// taken as they were written.
pub(crate) fn opaque_bytes(value: &Value) -> Result<Vec<u8>, Mismatch> {
    let wrong = |reason: &str| Mismatch::new(reason).help("write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`");
    let hex = match value {
        Value::Bytes(bytes) => return Ok(bytes.clone()),
        Value::Opaque(opaque) => opaque.hex.clone(),
        map => match (map.get("text").and_then(written), map.get("hex").and_then(written)) {
            (Some(text), None) => return Ok(text.into_bytes()),
            (None, Some(hex)) => hex,
            _ => return Err(wrong("expected bytes")),
        },
    };
    if hex.ends_with("...") {
        return Err(wrong("the hexadecimal text is not complete"));
    }
    from_hex(&hex).ok_or_else(|| wrong(&format!("expected pairs of hexadecimal digits, found `{}`", excerpt(&hex))))
}

/// A scalar as it was written; `None` for null, and for a value that is not a scalar.
fn written(value: &Value) -> Option<String> {
    match value.meaning() {
        Value::Text(_) | Value::Bool(_) | Value::Int(_) | Value::Uint(_) | Value::Float(_) => Some(key_text(value)),
        _ => None,
    }
}

/// Parses pairs of hexadecimal digits. They may be in groups with spaces between them, and each group may begin with
/// `0x`.
pub(crate) fn from_hex(text: &str) -> Option<Vec<u8>> {
    let mut digits: Vec<u8> = Vec::with_capacity(text.len());
    for group in text.split_ascii_whitespace() {
        match group.strip_prefix("0x").or_else(|| group.strip_prefix("0X")) {
            Some(group) if group.is_empty() || !group.len().is_multiple_of(2) => return None,
            Some(group) => digits.extend(group.bytes()),
            None => digits.extend(group.bytes()),
        }
    }
    let pair = |pair: &[u8]| match pair {
        [high, low] => Some((digit(*high)? << 4) | digit(*low)?),
        _ => None,
    };
    digits.chunks(2).map(pair).collect()
}

fn digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok())
}
