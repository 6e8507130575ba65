//! What the gates of the small system send, as bytes.

use scl::bytes::Bytes;

/// The message of this type with a number, which some of its fields show. Without a type, an image of 1 KiB.
pub(super) fn message(type_name: &str, number: u64) -> Bytes {
    let value = number as f64 / 10.0;
    match type_name {
        "rover.Measurement" => [double(1, value), varint(2, number)].concat(),
        "rover.Position" => {
            format!(r#"{{"latitude": {value:?}, "longitude": -0.5, "fix": "3d \u001b[31m"}}"#).into_bytes()
        }
        "rover.Setpoint" | "rover.Command" => double(1, value),
        "rover.Event" => text(1, &format!("event {number} \u{1b}[31mred")),
        "rover.Status" => [varint(1, 1), text(2, "within limits")].concat(),
        _ => vec![number.to_le_bytes()[0]; 1024],
    }
    .into()
}

fn double(field: u8, value: f64) -> Vec<u8> {
    [vec![field << 3 | 1], value.to_le_bytes().to_vec()].concat()
}

fn text(field: u8, text: &str) -> Vec<u8> {
    assert!(text.len() < 128, "one byte of length");
    [&[field << 3 | 2, text.len() as u8], text.as_bytes()].concat()
}

fn varint(field: u8, mut value: u64) -> Vec<u8> {
    let mut bytes = vec![field << 3];
    while value >= 128 {
        bytes.push(value as u8 | 128);
        value >>= 7;
    }
    bytes.push(value as u8);
    bytes
}
