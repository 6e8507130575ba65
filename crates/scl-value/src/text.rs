//! Values as texts: YAML and rows of a table.

mod documents;
mod table;
mod yaml;

pub use documents::Documents;
pub use table::Table;
pub use yaml::{ReadError, read_yaml, to_yaml};

use crate::error::EncodeError;
use crate::value::Value;

/// The bytes of an opaque message: bytes, or a map with `hex` or `text`.
pub(crate) fn opaque_bytes(value: &Value) -> Result<Vec<u8>, EncodeError> {
    let wrong = |reason: &str| EncodeError::new(reason).help("write `{hex: 01ff}`, `{text: hello}` or `!binary AQL/`");
    let hex = match value {
        Value::Bytes(bytes) => return Ok(bytes.clone()),
        Value::Opaque(opaque) => opaque.hex.clone(),
        map => match (map.get("text"), map.get("hex")) {
            (Some(Value::Text(text)), None) => return Ok(text.clone().into_bytes()),
            (None, Some(Value::Text(hex))) => hex.clone(),
            // `{hex: 10}` is a number in YAML.
            (None, Some(Value::Int(number))) => number.to_string(),
            _ => return Err(wrong("expected bytes")),
        },
    };
    if hex.ends_with("...") {
        return Err(wrong("the hexadecimal text is not complete"));
    }
    let digits: Vec<u8> = hex.bytes().filter(|byte| !byte.is_ascii_whitespace()).collect();
    let pair = |pair: &[u8]| match pair {
        [high, low] => Some((digit(*high)? << 4) | digit(*low)?),
        _ => None,
    };
    digits.chunks(2).map(pair).collect::<Option<_>>().ok_or_else(|| wrong("expected pairs of hexadecimal digits"))
}

fn digit(byte: u8) -> Option<u8> {
    char::from(byte).to_digit(16).and_then(|digit| u8::try_from(digit).ok())
}
