//! Errors of codecs.

use std::error::Error;

type Cause = Box<dyn Error + Send + Sync>;

/// A message could not be encoded.
#[derive(Debug, thiserror::Error)]
#[error("codec `{codec}` cannot encode this message: {reason}")]
pub struct EncodeError {
    codec: &'static str,
    reason: String,
    source: Option<Cause>,
}

/// Received bytes could not be decoded as a message of the expected type.
///
/// The usual causes are a peer that is not an SCL program, and two programs built with different versions of a schema.
#[derive(Debug, thiserror::Error)]
#[error("codec `{codec}` cannot decode this message: {reason}")]
pub struct DecodeError {
    codec: &'static str,
    reason: String,
    source: Option<Cause>,
}

macro_rules! codec_error {
    ($error:ident) => {
        impl $error {
            /// Creates an error of the codec named `codec`. By convention `reason` starts in lower case and has no full
            /// stop.
            pub fn new(codec: &'static str, reason: impl Into<String>) -> Self {
                Self { codec, reason: reason.into(), source: None }
            }

            /// Adds the error that caused this one, its [`source`](Error::source).
            #[must_use]
            pub fn caused_by(self, source: impl Into<Cause>) -> Self {
                Self { source: Some(source.into()), ..self }
            }

            /// The codec's name.
            pub fn codec(&self) -> &'static str {
                self.codec
            }

            /// Why the codec cannot do it.
            pub fn reason(&self) -> &str {
                &self.reason
            }
        }
    };
}

codec_error!(EncodeError);
codec_error!(DecodeError);

#[allow(dead_code, reason = "the codecs that use it may be off")]
impl DecodeError {
    /// Creates the error for a frame of `length` bytes that does not decode as `what`.
    pub(crate) fn not_a(what: &str, codec: &'static str, length: usize, source: impl Into<Cause>) -> Self {
        Self::new(codec, format!("this {length}-byte frame is not a {what} of the expected type")).caused_by(source)
    }
}
