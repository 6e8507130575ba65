//! Texts in frames that a program in another language has encoded.
//!
//! Libraries of C and C++ put any bytes into a `string`, and most receivers refuse the whole message then. So the
//! sender, which can correct it, gets the error.

use crate::codec::EncodeError;
use crate::spec::GateSpec;
use crate::state::ComponentState;

/// Checks that texts are UTF-8.
pub(super) struct ForeignTexts {
    gate: &'static GateSpec,
    format: Format,
}

enum Format {
    Json,
    #[cfg(feature = "protobuf")]
    Protobuf(&'static str, scl_shape::TextCheck),
}

impl ForeignTexts {
    /// Returns `None` if this program encodes the messages itself, or they have no texts.
    pub(super) fn new(component: &ComponentState, gate: &'static GateSpec, codec: &str) -> Option<Self> {
        let format = match gate.codec {
            own if own == codec => return None,
            "json" => Format::Json,
            #[cfg(feature = "protobuf")]
            "protobuf" => {
                let message = gate.sent_and_received().0?;
                Format::Protobuf(message, scl_shape::TextCheck::new(component.message_types()?, message)?)
            }
            _ => return None,
        };
        let _ = component;
        Some(Self { gate, format })
    }

    pub(super) fn check(&self, frame: &[u8]) -> Result<(), EncodeError> {
        let refused = |reason| Err(EncodeError::new(self.gate.codec, reason));
        match &self.format {
            Format::Json => match std::str::from_utf8(frame) {
                Ok(_) => Ok(()),
                Err(error) => refused(format!("byte {} is not UTF-8, as JSON must be", error.valid_up_to())),
            },
            #[cfg(feature = "protobuf")]
            Format::Protobuf(message, texts) => match texts.check(frame) {
                Ok(()) => Ok(()),
                Err(field) => refused(format!(
                    "field `{field}` of `{message}` is not UTF-8, as a `string` must be; `bytes` may be anything"
                )),
            },
        }
    }
}
