//! The guarantees of a codec, for the messages of one type.
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

/// Every guarantee; `samples` are messages that the codec can carry.
///
/// # Panics
/// When a guarantee does not hold; the text says which codec, and for which bytes.
pub fn all<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    round_trips::<C, T>(samples);
    keeps_what_is_in_front::<C, T>(samples);
    makes_the_same_frame::<C, T>(samples);
    ignores_no_byte::<C, T>(samples);
    survives_truncation::<C, T>(samples);
    survives_damage::<C, T>(samples);
    survives_repetition::<C, T>();
}

/// What was encoded is decoded as the same message.
pub fn round_trips<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        match C::decode(encoded::<C, T>(sample)) {
            Ok(message) => assert_eq!(message, *sample, "codec `{}` changes a message", C::NAME),
            Err(error) => panic!("codec `{}` does not read {sample:?}, which it wrote: {error}", C::NAME),
        }
    }
}

/// Encoding appends, and leaves what is in front as it was.
pub fn keeps_what_is_in_front<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        let mut into = BytesMut::from(&b"in front"[..]);
        write::<C, T>(sample, &mut into);
        assert!(into.starts_with(b"in front"), "codec `{}` writes over what is in front", C::NAME);
        let behind = into.split_off(8).freeze();
        let message = read::<C, T>(behind);
        assert_eq!(message.as_ref(), Some(sample), "codec `{}` depends on what is in front", C::NAME);
    }
}

/// A frame holds what is encoded, whatever the memory was used for before, and leaves the memory empty.
pub fn makes_the_same_frame<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    let mut memory = BytesMut::new();
    for sample in samples.iter().chain(samples.iter().rev()) {
        match C::to_frame(sample, &mut memory) {
            Ok(frame) => assert_eq!(frame, encoded::<C, T>(sample), "codec `{}` makes another frame", C::NAME),
            Err(error) => panic!("codec `{}` makes no frame of {sample:?}, which it encodes: {error}", C::NAME),
        }
        assert!(memory.is_empty(), "codec `{}` leaves something in the memory", C::NAME);
    }
}

/// A byte behind a message makes it an error, or another message; none is passed over in silence.
pub fn ignores_no_byte<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for sample in samples {
        let frame = encoded::<C, T>(sample);
        for byte in [0x00, 0x01, b'x', 0xff] {
            let message = read::<C, T>([&frame[..], &[byte]].concat().into());
            assert_ne!(message.as_ref(), Some(sample), "codec `{}` ignores {byte:#04x} behind {frame:?}", C::NAME);
        }
    }
}

/// A message cut off after any byte is an error or a message, and no panic.
pub fn survives_truncation<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    for frame in samples.iter().map(encoded::<C, T>) {
        for length in 0..frame.len() {
            read::<C, T>(frame.slice(..length));
        }
    }
}

/// Damaged messages and noise are errors or messages that can be sent again, and no panic.
pub fn survives_damage<C: Codec<T>, T: PartialEq + Debug>(samples: &[T]) {
    let mut noise = Noise(0x9e37_79b9_7f4a_7c15);
    for round in 0..5000 {
        let bytes: Bytes = std::iter::repeat_with(|| noise.next()).take(round % 40).collect();
        read::<C, T>(bytes);
    }
    for frame in samples.iter().map(encoded::<C, T>).filter(|frame| !frame.is_empty()) {
        for _ in 0..2000 {
            let mut damaged = frame.to_vec();
            let place = usize::from(noise.next()) << 8 | usize::from(noise.next());
            damaged[place % frame.len()] = noise.next();
            read::<C, T>(damaged.into());
        }
    }
}

/// A megabyte of one byte, for each byte, is an error or a message: it fills neither the stack nor the memory.
///
/// This is the frame that nests deepest in many formats, and one that announces much.
pub fn survives_repetition<C: Codec<T>, T: PartialEq + Debug>() {
    for byte in 0..=255 {
        drop(C::decode(vec![byte; 1 << 20].into()));
    }
}

fn write<C: Codec<T>, T: Debug>(message: &T, into: &mut BytesMut) {
    if let Err(error) = C::encode(message, into) {
        panic!("codec `{}` does not write {message:?}: {error}", C::NAME);
    }
}

fn encoded<C: Codec<T>, T: Debug>(message: &T) -> Bytes {
    let mut into = BytesMut::new();
    write::<C, T>(message, &mut into);
    into.freeze()
}

/// The message, if it is one; then it can be written too, and else the error names its codec.
fn read<C: Codec<T>, T: Debug>(bytes: Bytes) -> Option<T> {
    match C::decode(bytes) {
        Ok(message) => {
            write::<C, T>(&message, &mut BytesMut::new());
            Some(message)
        }
        Err(error) => {
            assert_eq!(error.codec(), C::NAME, "an error names another codec");
            assert!(!error.reason().is_empty(), "an error of codec `{}` gives no reason", C::NAME);
            None
        }
    }
}

/// Bytes that look like chance and are the same in every run.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u8 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) as u8
    }
}
