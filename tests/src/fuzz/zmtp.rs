//! What a stranger says to an end: ZMTP 3.0 (RFC 23), or bytes that begin like it, or none of it.

use arbitrary::{Result, Unstructured};

/// So much fits into a socket that nobody reads, also in small pieces.
const MOST_BYTES: usize = 16 << 10;
const MOST_PIECES: usize = 64;

const MORE: u8 = 1;
const LONG: u8 = 2;
const COMMAND: u8 = 4;
const GREETING: &[u8; 64] = b"\xff\0\0\0\0\0\0\0\0\x7f\x03\0NULL\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\
    \0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
const KINDS: [&[u8]; 9] = [b"PUSH", b"PULL", b"PUB", b"SUB", b"XPUB", b"REQ", b"REP", b"DEALER", b"ROUTER"];

/// The pieces in which a stranger speaks, who mostly introduces itself properly as a socket of one kind.
pub(super) fn speech(bytes: &mut Unstructured<'_>, kind: &[u8]) -> Result<Vec<Vec<u8>>> {
    let lengths = bytes.arbitrary()?;
    let mut said = Vec::new();
    if bytes.ratio(7, 8)? {
        said.extend_from_slice(GREETING);
        introduce(bytes, kind, &mut said)?;
    }
    while !bytes.is_empty() && said.len() < MOST_BYTES / 2 {
        match bytes.int_in_range(0..=7)? {
            0..=3 => message(bytes, &mut said)?,
            4 => introduce(bytes, kind, &mut said)?,
            5 => frame(COMMAND | bytes.arbitrary::<u8>()?, &content(bytes)?, &mut said),
            6 => said.extend_from_slice(GREETING),
            _ => said.extend(content(bytes)?),
        }
    }
    said.truncate(MOST_BYTES);
    keep_announcements_small(&mut said);
    Ok(cut(lengths, said))
}

/// READY with the kind of the socket, sometimes a wrong one, and sometimes a name.
fn introduce(bytes: &mut Unstructured<'_>, kind: &[u8], said: &mut Vec<u8>) -> Result<()> {
    let kind = if bytes.ratio(1, 16)? { *bytes.choose(&KINDS)? } else { kind };
    let mut body = b"\x05READY".to_vec();
    property(b"Socket-Type", kind, &mut body);
    if bytes.ratio(1, 4)? {
        property(b"Identity", &content(bytes)?, &mut body);
    }
    frame(COMMAND, &body, said);
    Ok(())
}

fn property(name: &[u8], value: &[u8], body: &mut Vec<u8>) {
    body.push(name.len() as u8);
    body.extend_from_slice(name);
    body.extend((value.len() as u32).to_be_bytes());
    body.extend_from_slice(value);
}

/// Up to six frames, among them all shapes of an envelope; now and then the last one is not the last.
fn message(bytes: &mut Unstructured<'_>, said: &mut Vec<u8>) -> Result<()> {
    for _ in 0..bytes.int_in_range(0..=5)? {
        frame(MORE, &content(bytes)?, said);
    }
    let open = u8::from(bytes.ratio(1, 16)?);
    frame(open, &content(bytes)?, said);
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
    // A subscription, or the number of a request, without waiting for the fuzzer to hit on one.
    content.resize(length, 1);
    Ok(content)
}

fn frame(flags: u8, body: &[u8], said: &mut Vec<u8>) {
    match u8::try_from(body.len()) {
        Ok(length) if flags & LONG == 0 => said.extend([flags, length]),
        _ => {
            said.push(flags | LONG);
            said.extend((body.len() as u64).to_be_bytes());
        }
    }
    said.extend_from_slice(body);
}

/// Reads along and bounds each announced length to 16 MiB. The library reserves whatever is announced, and where that is
/// more than there is, the process ends: see "What remains" in `docs/zeromq.md`.
fn keep_announcements_small(said: &mut [u8]) {
    let mut at = GREETING.len();
    while let Some(&flags) = said.get(at) {
        let length = if flags & LONG == 0 {
            at += 2;
            said.get(at - 1).map_or(0, |&length| usize::from(length))
        } else {
            at += 9;
            let Some(length) = said.get_mut(at - 8..at) else { return };
            length[..5].fill(0);
            length.iter().fold(0, |length, &byte| length << 8 | usize::from(byte))
        };
        at += length;
    }
}

/// Cuts off pieces of the given lengths, again and again; a length of 0 leaves the rest whole.
fn cut(lengths: [u8; 4], mut said: Vec<u8>) -> Vec<Vec<u8>> {
    let mut pieces = Vec::new();
    for length in lengths.into_iter().cycle().take(MOST_PIECES - 1).map(usize::from) {
        if length == 0 || length >= said.len() {
            break;
        }
        let rest = said.split_off(length);
        pieces.push(std::mem::replace(&mut said, rest));
    }
    pieces.push(said);
    pieces
}
