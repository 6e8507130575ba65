//! Bytes of ZMTP 3.0 (RFC 23), put together by hand so that tests can also say what no library would.

/// Frame flag: more frames of this message follow.
pub const MORE: u8 = 1;
/// Frame flag: the length takes 8 bytes.
pub const LONG: u8 = 2;
/// Frame flag: a command.
pub const COMMAND: u8 = 4;

/// The greeting of a ZMTP 3.0 client without security.
pub fn greeting() -> Vec<u8> {
    greeting_with(b"NULL")
}

/// A greeting that names a security mechanism.
pub fn greeting_with(mechanism: &[u8]) -> Vec<u8> {
    let mut greeting = b"\xff\0\0\0\0\0\0\0\0\x7f\x03\0".to_vec();
    greeting.extend_from_slice(mechanism);
    greeting.resize(64, 0);
    greeting
}

/// The READY command of a socket type such as `SUB`.
pub fn ready(socket_type: &str) -> Vec<u8> {
    command("READY", &property("Socket-Type", socket_type.as_bytes()))
}

/// A property for the READY command.
pub fn property(name: &str, value: &[u8]) -> Vec<u8> {
    let length = (value.len() as u32).to_be_bytes();
    [&[name.len() as u8], name.as_bytes(), &length, value].concat()
}

/// A command.
pub fn command(name: &str, data: &[u8]) -> Vec<u8> {
    frame(COMMAND, &[&[name.len() as u8], name.as_bytes(), data].concat())
}

/// A message of several frames.
pub fn message(parts: &[&[u8]]) -> Vec<u8> {
    let last = parts.len() - 1;
    let frames = parts.iter().enumerate().map(|(index, part)| frame(if index < last { MORE } else { 0 }, part));
    frames.collect::<Vec<_>>().concat()
}

/// A subscription to all messages that start with `prefix`, as ZMTP 3.0 sends it.
pub fn subscribe(prefix: &[u8]) -> Vec<u8> {
    message(&[&[b"\x01", prefix].concat()])
}

/// One frame; long ones get the long form by themselves.
pub fn frame(flags: u8, body: &[u8]) -> Vec<u8> {
    let mut frame = match u8::try_from(body.len()) {
        Ok(length) => vec![flags, length],
        Err(_) => announcement(flags, body.len() as u64),
    };
    frame.extend_from_slice(body);
    frame
}

/// The beginning of a frame whose body is `length` bytes long.
pub fn announcement(flags: u8, length: u64) -> Vec<u8> {
    [&[flags | LONG][..], &length.to_be_bytes()].concat()
}
