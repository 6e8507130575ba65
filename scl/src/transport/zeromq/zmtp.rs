//! ZMTP 3.0 (RFC 23): what both sides say first, how messages are framed, and what a subscriber says.
//!
//! Later versions of the protocol speak like 3.0 to a side that announces 3.0.

use bytes::{Buf, Bytes, BytesMut};

const GREETING: usize = 64;
const NULL_MECHANISM: &[u8] = b"NULL\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0";
const LONG: u8 = 2;
const COMMAND: u8 = 4;
/// The most that a subscriber may say at once: more than any topic or command of theirs needs.
const LONGEST: u64 = 64 * 1024;

/// What a socket of a kind says first: the greeting, no security, and that it is ready.
pub(super) fn hello(kind: &str) -> Vec<u8> {
    let mut hello = b"\xff\0\0\0\0\0\0\0\0\x7f\x03\0".to_vec();
    hello.extend_from_slice(NULL_MECHANISM);
    hello.resize(GREETING, 0);
    let ready = [b"\x05READY\x0bSocket-Type\0\0\0", &[kind.len() as u8][..], kind.as_bytes()].concat();
    hello.extend_from_slice(&[COMMAND, ready.len() as u8]);
    hello.extend_from_slice(&ready);
    hello
}

/// The answer to a PING.
pub(super) fn pong(context: &[u8]) -> Bytes {
    // A longer context than the protocol allows is cut.
    let context = &context[..context.len().min(16)];
    [&[COMMAND, 5 + context.len() as u8], &b"\x04PONG"[..], context].concat().into()
}

/// What stands in front of a message of one frame.
pub(super) struct Header {
    bytes: [u8; 9],
    length: usize,
}

impl Header {
    pub(super) fn of(message: &[u8]) -> Self {
        let length = message.len() as u64;
        let [.., short] = length.to_be_bytes();
        let mut bytes = [0; 9];
        if length == u64::from(short) {
            bytes[1] = short;
            return Self { bytes, length: 2 };
        }
        bytes[0] = LONG;
        bytes[1..].copy_from_slice(&length.to_be_bytes());
        Self { bytes, length: 9 }
    }

    pub(super) fn as_bytes(&self) -> &[u8] {
        &self.bytes[..self.length]
    }
}

/// Something that a subscriber said.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Word {
    /// It is a subscriber.
    Ready,
    /// It wants what begins so.
    Subscribe(Bytes),
    /// It no longer wants what begins so.
    Cancel(Bytes),
    /// It wants to know whether anybody is there.
    Ping(Bytes),
}

/// What was said is none of what a subscriber says; the connection is of no use.
#[derive(Debug, thiserror::Error, PartialEq, Eq)]
pub(super) enum Nonsense {
    #[error("it does not speak ZMTP 3 without security")]
    NoGreeting,
    #[error("it is no subscriber")]
    NoSubscriber,
    #[error("it announced {0} bytes at once")]
    TooLong(u64),
}

/// What was heard of a subscriber.
#[derive(Default)]
pub(super) struct Hearing {
    heard: BytesMut,
    greeted: bool,
    ready: bool,
}

struct Frame {
    flags: u8,
    body: Bytes,
}

impl Hearing {
    /// Where what is heard is to be appended.
    pub(super) fn memory(&mut self) -> &mut BytesMut {
        self.heard.reserve(256);
        &mut self.heard
    }

    /// The next word, if it was heard to its end.
    pub(super) fn next_word(&mut self) -> Result<Option<Word>, Nonsense> {
        if !self.greeted && !self.take_greeting()? {
            return Ok(None);
        }
        while let Some(frame) = self.take_frame()? {
            if let Some(word) = self.read(frame)? {
                return Ok(Some(word));
            }
        }
        Ok(None)
    }

    fn take_greeting(&mut self) -> Result<bool, Nonsense> {
        let heard = &self.heard;
        let differs = |place: usize, right: fn(u8) -> bool| heard.get(place).is_some_and(|&byte| !right(byte));
        // Judged as soon as it is heard, because whoever speaks otherwise may stay silent then.
        if differs(0, |byte| byte == 0xff) || differs(9, |byte| byte == 0x7f) || differs(10, |byte| byte >= 3) {
            return Err(Nonsense::NoGreeting);
        }
        if heard.len() < GREETING {
            return Ok(false);
        }
        let greeting = self.heard.split_to(GREETING);
        self.greeted = greeting[12..32] == *NULL_MECHANISM;
        if self.greeted { Ok(true) } else { Err(Nonsense::NoGreeting) }
    }

    fn take_frame(&mut self) -> Result<Option<Frame>, Nonsense> {
        let heard = &self.heard[..];
        let Some(&flags) = heard.first() else { return Ok(None) };
        let (length, header) = if flags & LONG == 0 {
            let Some(&length) = heard.get(1) else { return Ok(None) };
            (u64::from(length), 2)
        } else {
            let Some(mut length) = heard.get(1..9) else { return Ok(None) };
            (length.get_u64(), 9)
        };
        if length > LONGEST {
            return Err(Nonsense::TooLong(length));
        }
        let end = header + length as usize;
        if heard.len() < end {
            return Ok(None);
        }
        let mut body = self.heard.split_to(end).freeze();
        body.advance(header);
        Ok(Some(Frame { flags, body }))
    }

    fn read(&mut self, Frame { flags, mut body }: Frame) -> Result<Option<Word>, Nonsense> {
        if flags & COMMAND != 0 {
            return self.read_command(&body);
        }
        if !self.ready {
            return Err(Nonsense::NoSubscriber);
        }
        // A frame that others belong to is no subscription, and the others have no first byte that says so.
        let what = body.try_get_u8().ok().filter(|_| flags == 0 || flags == LONG);
        Ok(match what {
            Some(1) => Some(Word::Subscribe(body)),
            Some(0) => Some(Word::Cancel(body)),
            _ => None,
        })
    }

    fn read_command(&mut self, body: &Bytes) -> Result<Option<Word>, Nonsense> {
        let length = body.first().map_or(0, |&length| usize::from(length));
        let Some((name, content)) = body.get(1..).and_then(|rest| rest.split_at_checked(length)) else {
            return Err(Nonsense::NoSubscriber);
        };
        let content = body.slice_ref(content);
        if !self.ready {
            self.ready = name == b"READY" && is_subscriber(&content);
            return if self.ready { Ok(Some(Word::Ready)) } else { Err(Nonsense::NoSubscriber) };
        }
        Ok(match name {
            b"SUBSCRIBE" => Some(Word::Subscribe(content)),
            b"CANCEL" => Some(Word::Cancel(content)),
            // Two bytes say how long it waits for an answer.
            b"PING" => Some(Word::Ping(content.slice(content.len().min(2)..))),
            _ => None,
        })
    }
}

/// Whether the properties of READY say that the other side is a socket that subscribes.
fn is_subscriber(mut properties: &[u8]) -> bool {
    while let Some((name, value, rest)) = split_property(properties) {
        if name.eq_ignore_ascii_case(b"Socket-Type") {
            return value == b"SUB" || value == b"XSUB";
        }
        properties = rest;
    }
    false
}

fn split_property(properties: &[u8]) -> Option<(&[u8], &[u8], &[u8])> {
    let (&length, rest) = properties.split_first()?;
    let (name, mut rest) = rest.split_at_checked(length.into())?;
    let length = rest.try_get_u32().ok()?;
    let (value, rest) = rest.split_at_checked(length as usize)?;
    Some((name, value, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is heard when a stranger says something, in pieces of so many bytes.
    fn words(said: &[u8], piece: usize) -> Result<Vec<Word>, Nonsense> {
        let mut hearing = Hearing::default();
        let mut words = Vec::new();
        for piece in said.chunks(piece) {
            hearing.memory().extend_from_slice(piece);
            while let Some(word) = hearing.next_word()? {
                words.push(word);
            }
        }
        Ok(words)
    }

    fn after_hello(kind: &str, said: &[u8]) -> Vec<u8> {
        [&hello(kind)[..], said].concat()
    }

    #[test]
    fn a_subscriber_is_understood_however_its_words_are_cut() {
        let long = [&[LONG, 0, 0, 0, 0, 0, 0, 1, 1, 1][..], &[b'x'; 256]].concat();
        let said = [b"\0\x01\x01", &long[..], b"\0\x03\0ab\x04\x0a\x09SUBSCRIBE\x04\x0a\x04PING\0\x07tick"].concat();
        let expected = [
            Word::Ready,
            Word::Subscribe(Bytes::new()),
            Word::Subscribe(Bytes::from(vec![b'x'; 256])),
            Word::Cancel(Bytes::from_static(b"ab")),
            Word::Subscribe(Bytes::new()),
            Word::Ping(Bytes::from_static(b"tic")),
        ];
        let said = after_hello("SUB", &said);
        for piece in [1, 2, 7, 64, 1000] {
            assert_eq!(words(&said, piece).as_deref(), Ok(&expected[..]), "in pieces of {piece}");
        }
    }

    #[test]
    fn whoever_is_no_subscriber_is_told_from_one_at_once() {
        let cases: [(&[u8], Nonsense); 7] = [
            (b"GET / HTTP/1.1", Nonsense::NoGreeting),
            (b"\xff\0\0\0\0\0\0\0\0\x01", Nonsense::NoGreeting),
            (b"\xff\0\0\0\0\0\0\0\0\x7f\x02", Nonsense::NoGreeting),
            (&hello("PUSH"), Nonsense::NoSubscriber),
            (&after_hello("SUB", b"")[..GREETING], Nonsense::NoSubscriber),
            (&after_hello("SUB", b"\x04\x01\x09"), Nonsense::NoSubscriber),
            (&after_hello("SUB", b"\x02\0\0\0\x08\0\0\0\0"), Nonsense::TooLong(32 << 30)),
        ];
        for (said, expected) in cases {
            let said = if said.len() == GREETING { [said, b"\0\x01\x01"].concat() } else { said.to_vec() };
            assert_eq!(words(&said, 5), Err(expected), "{said:?}");
        }
    }

    #[test]
    fn messages_of_several_frames_and_unknown_commands_are_passed_over() {
        let said = after_hello("XSUB", b"\x01\x01\x01\x04\x05\x04WHAT\0\0\0\x02\x01a");
        assert_eq!(words(&said, 3), Ok(vec![Word::Ready, Word::Subscribe(Bytes::from_static(b"a"))]));
    }

    #[test]
    fn a_header_says_the_length_of_what_follows() {
        let cases: [(usize, &[u8]); 4] = [
            (0, &[0, 0]),
            (255, &[0, 255]),
            (256, &[2, 0, 0, 0, 0, 0, 0, 1, 0]),
            (70_000, &[2, 0, 0, 0, 0, 0, 1, 0x11, 0x70]),
        ];
        for (length, expected) in cases {
            assert_eq!(Header::of(&vec![7; length]).as_bytes(), expected);
        }
    }
}
