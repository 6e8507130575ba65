//! Encoding into reused memory.

use super::foreign_texts::ForeignTexts;
use crate::codec::{Codec, EncodeError};
use crate::spec::GateSpec;
use crate::state::ComponentState;
use bytes::{Bytes, BytesMut};
use std::any::TypeId;

/// Memory for encoded messages is allocated in pieces of this size; a piece is reused when all its messages are
/// dropped.
const PIECE: usize = 16 * 1024;

/// How a gate turns messages into frames.
pub(crate) struct Encoding<T> {
    to_frame: fn(&T, &mut BytesMut) -> Result<Bytes, EncodeError>,
    memory: BytesMut,
    codec: TypeId,
    texts: Option<Box<ForeignTexts>>,
}

impl<T> Encoding<T> {
    /// Creates the encoding of the messages that a gate of this component sends.
    pub(crate) fn new<C: Codec<T>>(component: &ComponentState, gate: &'static GateSpec) -> Self {
        let texts = ForeignTexts::new(component, gate, C::NAME).map(Box::new);
        Self { to_frame: C::to_frame, memory: BytesMut::new(), codec: TypeId::of::<C>(), texts }
    }

    /// Returns true if the gate's codec is `C`.
    pub(crate) fn is<C: Codec<T>>(&self) -> bool {
        self.codec == TypeId::of::<C>()
    }

    #[inline]
    pub(crate) fn encode(&mut self, message: &T) -> Result<Bytes, EncodeError> {
        if self.memory.capacity() < PIECE / 16 {
            self.memory.reserve(PIECE);
        }
        let frame = (self.to_frame)(message, &mut self.memory);
        // Discard what a codec wrote before it failed, or it would become part of the next message.
        self.memory.clear();
        match &self.texts {
            Some(texts) => frame.and_then(|frame| texts.check(&frame).map(|()| frame)),
            None => frame,
        }
    }
}
