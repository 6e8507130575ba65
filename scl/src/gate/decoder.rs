//! Decoding, and how much memory it may take.

use crate::codec::{Codec, DecodeError};
use crate::spec::GateSpec;
use crate::state::ComponentState;
use bytes::Bytes;
#[cfg(feature = "protobuf")]
use scl_shape::{Format, Language, MemoryEstimate};

/// How much memory a decoded message may take, in multiples of the gate's `max_size`.
#[cfg(feature = "protobuf")]
const FACTOR: u64 = 16;
/// A smaller `max_size` counts as this one when memory is limited, because small messages of JSON take more than 16
/// times their length.
#[cfg(feature = "protobuf")]
const LEAST_SIZE: u64 = 1 << 20;

/// Decodes the messages that a gate receives.
pub(super) struct Decoder<T> {
    decode: fn(Bytes) -> Result<T, DecodeError>,
    /// The length up to which no frame can take too much memory.
    unchecked: usize,
    #[cfg(feature = "protobuf")]
    limit: Option<Box<MemoryLimit>>,
}

impl<T> Decoder<T> {
    /// Creates the decoder for the messages that a gate of this component receives.
    pub(super) fn new<C: Codec<T>>(component: &ComponentState, gate: &'static GateSpec) -> Self {
        #[cfg(feature = "protobuf")]
        {
            let limit = MemoryLimit::new(component, gate, C::NAME);
            let unchecked = limit.as_ref().map_or(usize::MAX, MemoryLimit::unchecked);
            Self { decode: C::decode, unchecked, limit: limit.map(Box::new) }
        }
        #[cfg(not(feature = "protobuf"))]
        {
            let _ = (component, gate);
            Self { decode: C::decode, unchecked: usize::MAX }
        }
    }

    // If this were inlined, the compiler would move the frame in pieces.
    #[inline(never)]
    pub(super) fn decode(&self, frame: Bytes) -> Result<T, DecodeError> {
        if frame.len() > self.unchecked {
            self.check(&frame)?;
        }
        (self.decode)(frame)
    }

    #[cold]
    fn check(&self, frame: &[u8]) -> Result<(), DecodeError> {
        #[cfg(feature = "protobuf")]
        if let Some(limit) = &self.limit {
            limit.check(frame)?;
        }
        let _ = frame;
        Ok(())
    }
}

/// The limit for messages of `schemas:`. Other types do not say how much memory they take.
#[cfg(feature = "protobuf")]
struct MemoryLimit {
    gate: &'static GateSpec,
    message: &'static str,
    estimate: MemoryEstimate,
}

#[cfg(feature = "protobuf")]
impl MemoryLimit {
    fn new(component: &ComponentState, gate: &'static GateSpec, codec: &str) -> Option<Self> {
        let format = match gate.codec {
            "protobuf" => Format::Protobuf,
            "json" => Format::Json,
            _ => return None,
        };
        // An untyped gate passes its frames undecoded to a program in another language.
        let language = if codec == gate.codec { Language::Rust } else { Language::Other };
        let message = gate.sent_and_received().1?;
        let estimate = MemoryEstimate::new(component.message_types()?, message, language, format)?;
        Some(Self { gate, message, estimate })
    }

    fn bytes(&self) -> u64 {
        self.gate.options.max_size.max(LEAST_SIZE).saturating_mul(FACTOR)
    }

    fn unchecked(&self) -> usize {
        usize::try_from(self.bytes() / self.estimate.most_per_byte()).unwrap_or(usize::MAX)
    }

    fn check(&self, frame: &[u8]) -> Result<(), DecodeError> {
        let (codec, length, message, limit) = (self.gate.codec, frame.len(), self.message, self.bytes());
        let estimate = self.estimate.of(frame);
        let estimate = estimate.map_err(|error| DecodeError::not_a("message", codec, length, error))?;
        if estimate <= limit {
            return Ok(());
        }
        let reason = format!(
            "this {length}-byte frame of `{message}` would take about {} MiB of memory, and the gate's `max_size` allows \
             {} MiB ({FACTOR} times `max_size`, at least {} MiB); send smaller messages, or declare a larger `max_size`",
            estimate.div_ceil(1 << 20),
            limit >> 20,
            (LEAST_SIZE * FACTOR) >> 20,
        );
        Err(DecodeError::new(codec, reason))
    }
}
