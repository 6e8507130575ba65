//! What a stranger sends to an end: ZMTP 3.0 (RFC 23) with SCL's additions, or bytes that begin like it, or noise.

use crate::zmtp::{COMMAND, MORE, announcement, command, frame, greeting, greeting_with, property};
use arbitrary::{Result, Unstructured};

/// What fits into a socket that nobody reads, even in small pieces.
const MOST_BYTES: usize = 16 << 10;
const MOST_PIECES: usize = 64;

const SOCKET_TYPES: [&[u8]; 9] = [b"PUSH", b"PULL", b"PUB", b"SUB", b"XPUB", b"REQ", b"REP", b"DEALER", b"ROUTER"];
const COMMANDS: [&str; 11] = [
    "X-SCL-ACK",
    "X-SCL-BEHIND",
    "X-SCL-CATCH-UP",
    "X-SCL-CAUGHT-UP",
    "X-SCL-FLUSH",
    "SUBSCRIBE",
    "CANCEL",
    "PING",
    "PONG",
    "ERROR",
    "OTHER",
];
/// Values of the property `X-SCL`.
const ADDITIONS: [&[u8]; 8] = [
    b"1",
    b"1 window=256,1048576",
    b"1 window=64,32768 newest",
    b"1 window=1,1",
    b"1 window=18446744073709551615,18446744073709551615",
    b"1 window=0,0 newest window=",
    b"2 window=1,1",
    b"\xff",
];
/// Lengths that nobody means.
const LENGTHS: [u64; 6] = [(1 << 20) + 1, 16 << 30, 64 << 30, 1 << 40, 1 << 63, u64::MAX];

/// The pieces that a stranger sends, which mostly introduces itself properly as a socket of a type.
pub(super) fn stream(bytes: &mut Unstructured<'_>, socket_type: &[u8]) -> Result<Vec<Vec<u8>>> {
    let lengths = bytes.arbitrary()?;
    let mut stream = Vec::new();
    if bytes.ratio(7, 8)? {
        stream.extend(greeting());
        put_ready(bytes, socket_type, &mut stream)?;
    } else {
        stream.extend(other_greeting(bytes)?);
    }
    while !bytes.is_empty() && stream.len() < MOST_BYTES / 2 {
        match bytes.int_in_range(0..=9)? {
            0..=3 => put_message(bytes, &mut stream)?,
            4 => put_ready(bytes, socket_type, &mut stream)?,
            5 | 6 => put_command(bytes, &mut stream)?,
            7 => stream.extend(frame(COMMAND | bytes.arbitrary::<u8>()?, &content(bytes)?)),
            8 => put_enormous(bytes, &mut stream)?,
            _ => stream.extend(content(bytes)?),
        }
    }
    stream.truncate(MOST_BYTES);
    Ok(cut(lengths, stream))
}

/// A greeting of another version or mechanism, or with any byte changed.
fn other_greeting(bytes: &mut Unstructured<'_>) -> Result<Vec<u8>> {
    let mut greeting = greeting();
    match bytes.int_in_range(0..=4)? {
        0 => greeting = b"\x01\0".to_vec(),
        1 => greeting[10] = bytes.int_in_range(0..=4)?,
        2 => greeting = greeting_with(b"CURVE"),
        3 => greeting[bytes.int_in_range(0..=63)?] = bytes.arbitrary()?,
        _ => greeting.truncate(bytes.int_in_range(0..=63)?),
    }
    Ok(greeting)
}

/// READY with the socket type, now and then a wrong one, sometimes an identity, often SCL's property.
fn put_ready(bytes: &mut Unstructured<'_>, socket_type: &[u8], stream: &mut Vec<u8>) -> Result<()> {
    let socket_type = if bytes.ratio(1, 16)? { *bytes.choose(&SOCKET_TYPES)? } else { socket_type };
    let mut properties = property("Socket-Type", socket_type);
    if bytes.ratio(1, 4)? {
        properties.extend(property("Identity", &content(bytes)?));
    }
    if bytes.ratio(3, 4)? {
        properties.extend(property("X-SCL", bytes.choose(&ADDITIONS)?));
    }
    stream.extend(command("READY", &properties));
    Ok(())
}

/// A command with a number, often a small one, or with any content.
fn put_command(bytes: &mut Unstructured<'_>, stream: &mut Vec<u8>) -> Result<()> {
    let name = bytes.choose(&COMMANDS)?;
    let data = match bytes.int_in_range(0..=3)? {
        0 => Vec::new(),
        1 => bytes.int_in_range(0..=300_u64)?.to_be_bytes().to_vec(),
        2 => bytes.arbitrary::<u64>()?.to_be_bytes().to_vec(),
        _ => content(bytes)?,
    };
    stream.extend(command(name, &data));
    Ok(())
}

/// Up to six frames, which include all shapes of an envelope; now and then the last one has the flag MORE.
fn put_message(bytes: &mut Unstructured<'_>, stream: &mut Vec<u8>) -> Result<()> {
    for _ in 0..bytes.int_in_range(0..=5)? {
        stream.extend(frame(MORE, &content(bytes)?));
    }
    let more = u8::from(bytes.ratio(1, 16)?);
    stream.extend(frame(more, &content(bytes)?));
    Ok(())
}

/// A frame that announces more than is accepted, and its beginning.
fn put_enormous(bytes: &mut Unstructured<'_>, stream: &mut Vec<u8>) -> Result<()> {
    stream.extend(announcement(*bytes.choose(&[0, MORE, COMMAND])?, *bytes.choose(&LENGTHS)?));
    stream.extend(content(bytes)?);
    Ok(())
}

fn content(bytes: &mut Unstructured<'_>) -> Result<Vec<u8>> {
    let length = match bytes.int_in_range(0..=7)? {
        0..=2 => 0,
        3 => 1,
        4 | 5 => 8,
        6 => bytes.int_in_range(0..=40)?,
        _ => bytes.int_in_range(0..=700)?,
    };
    let mut content = bytes.bytes(length.min(bytes.len()))?.to_vec();
    // A subscription, or the number of a request, which the fuzzer need not find by itself.
    content.resize(length, 1);
    Ok(content)
}

/// Cuts off pieces of the given lengths, repeatedly; a length of 0 leaves the rest whole.
fn cut(lengths: [u8; 4], mut stream: Vec<u8>) -> Vec<Vec<u8>> {
    let mut pieces = Vec::new();
    for length in lengths.into_iter().cycle().take(MOST_PIECES - 1).map(usize::from) {
        if length == 0 || length >= stream.len() {
            break;
        }
        let rest = stream.split_off(length);
        pieces.push(std::mem::replace(&mut stream, rest));
    }
    pieces.push(stream);
    pieces
}
