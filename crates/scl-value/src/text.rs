//! Values as texts: YAML, JSON, rows of a table.

mod documents;
mod json;
mod table;
mod yaml;

pub use documents::Documents;
pub use json::to_json;
pub use table::Table;
pub use yaml::{ReadError, read_yaml, to_yaml};

use crate::error::EncodeError;
use crate::value::Value;
use base64::Engine;
use base64::engine::DecodePaddingMode;
use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig, STANDARD};

/// Bytes as base64, as in protobuf's JSON.
pub(crate) fn to_base64(bytes: &[u8]) -> String {
    STANDARD.encode(bytes)
}

/// Bytes from base64: of both alphabets, with or without padding, and with white space.
pub(crate) fn from_base64(text: &str) -> Result<Vec<u8>, String> {
    const LENIENT: GeneralPurpose = GeneralPurpose::new(
        &base64::alphabet::STANDARD,
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
    );
    let text: String = text.chars().filter(|c| !c.is_ascii_whitespace()).collect();
    LENIENT.decode(text.replace('-', "+").replace('_', "/")).map_err(|error| error.to_string())
}

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
