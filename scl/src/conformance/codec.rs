//! Checks that a codec keeps its guarantees for messages of one type.
//!
//! ```
//! use scl::codec::Json;
//! use scl::conformance::codec;
//!
//! codec::all::<Json, _>(&[vec![1.5, -2.0], vec![]]);
//! ```

use crate::codec::Codec;
use bytes::{Bytes, BytesMut};
use std::fmt::Debug;

/// Checks every guarantee; `samples` are messages that the codec can encode.
///
/// # Panics
/// If a guarantee does not hold. The message names the codec.
pub fn all<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    round_trips::<C, T>(samples);
    appends::<C, T>(samples);
    makes_the_same_frame::<C, T>(samples);
    ignores_no_byte::<C, T>(samples);
    survives_truncation::<C, T>(samples);
    survives_damage::<C, T>(samples);
    survives_repetition::<C, T>();
}

/// An encoded message is decoded as the same message.
pub fn round_trips<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        match C::decode(encoded::<C, T>(sample)) {
            Ok(message) => assert_eq!(message, *sample, "codec `{}` changes a message", C::NAME),
            Err(error) => panic!("codec `{}` does not decode its own encoding of {sample:?}: {error}", C::NAME),
        }
    }
}

/// Encoding appends, and changes nothing that the buffer already contains.
pub fn appends<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        let mut buffer = BytesMut::from(&b"in front"[..]);
        encode::<C, T>(sample, &mut buffer);
        assert!(buffer.starts_with(b"in front"), "codec `{}` overwrites what the buffer contains", C::NAME);
        let appended = buffer.split_off(8).freeze();
        let message = decode::<C, T>(appended);
        assert_eq!(message.as_ref(), Some(sample), "codec `{}` depends on what the buffer contains", C::NAME);
    }
}

/// A frame contains the encoded message, however often its buffer was used before, and leaves the buffer empty.
pub fn makes_the_same_frame<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    let mut buffer = BytesMut::new();
    for sample in samples.iter().chain(samples.iter().rev()) {
        match C::to_frame(sample, &mut buffer) {
            Ok(frame) => assert_eq!(
                frame,
                encoded::<C, T>(sample),
                "codec `{}` makes a frame that differs from the encoding",
                C::NAME
            ),
            Err(error) => panic!("codec `{}` encodes {sample:?} but makes no frame of it: {error}", C::NAME),
        }
        assert!(buffer.is_empty(), "codec `{}` leaves bytes in the buffer", C::NAME);
    }
}

/// With one more byte, a frame is an error or a different message: no byte is ignored.
pub fn ignores_no_byte<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        let frame = encoded::<C, T>(sample);
        for byte in [0x00, 0x01, b'x', 0xff] {
            let message = decode::<C, T>([&frame[..], &[byte]].concat().into());
            assert_ne!(message.as_ref(), Some(sample), "codec `{}` ignores {byte:#04x} after {frame:?}", C::NAME);
        }
    }
}

/// A truncated frame is an error or a message, never a panic.
pub fn survives_truncation<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for frame in samples.iter().map(encoded::<C, T>) {
        for length in 0..frame.len() {
            decode::<C, T>(frame.slice(..length));
        }
    }
}

/// Damaged frames and random bytes are errors or messages that can be encoded again, never a panic.
pub fn survives_damage<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    for round in 0..5000 {
        let bytes: Bytes = std::iter::repeat_with(|| noise.next()).take(round % 40).collect();
        decode::<C, T>(bytes);
    }
    for frame in samples.iter().map(encoded::<C, T>).filter(|frame| !frame.is_empty()) {
        for _ in 0..2000 {
            let mut damaged = frame.to_vec();
            let index = usize::from(noise.next()) << 8 | usize::from(noise.next());
            damaged[index % frame.len()] = noise.next();
            decode::<C, T>(damaged.into());
        }
    }
}

/// A megabyte of the same byte, for each byte value, is an error or a message, and exhausts neither stack nor memory.
///
/// In many formats, such frames nest deepest and announce the most elements.
pub fn survives_repetition<C: Codec<T>, T: PartialEq + Debug>() {
    for byte in 0..=255 {
        drop(C::decode(vec![byte; 1 << 20].into()));
    }
}

fn encode<C: Codec<T>, T: Debug>(message: &T, buffer: &mut BytesMut) {
    if let Err(error) = C::encode(message, buffer) {
        panic!("codec `{}` does not encode {message:?}: {error}", C::NAME);
    }
}

fn encoded<C: Codec<T>, T: Debug>(message: &T) -> Bytes {
    let mut buffer = BytesMut::new();
    encode::<C, T>(message, &mut buffer);
    buffer.freeze()
}

/// Returns the message if the bytes are one, and checks that it can be encoded; otherwise checks the error.
fn decode<C: Codec<T>, T: Debug>(bytes: Bytes) -> Option<T> {
    match C::decode(bytes) {
        Ok(message) => {
            encode::<C, T>(&message, &mut BytesMut::new());
            Some(message)
        }
        Err(error) => {
            assert_eq!(error.codec(), C::NAME, "an error of codec `{}` names another codec", C::NAME);
            assert!(!error.reason().is_empty(), "an error of codec `{}` gives no reason", C::NAME);
            None
        }
    }
}

/// Pseudo-random bytes, the same in every run.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u8 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) as u8
    }
}
