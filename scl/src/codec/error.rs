use std::error::Error;

type Cause = Box<dyn Error + Send + Sync>;

/// A message that its codec cannot write.
#[derive(Debug, thiserror::Error)]
#[error("codec `{codec}` cannot encode this message: {reason}")]
pub struct EncodeError {
    codec: &'static str,
    reason: String,
    source: Option<Cause>,
}

impl EncodeError {
    /// An error of the codec called `codec`; `reason` is lower case and ends without a full stop.
    pub fn new(codec: &'static str, reason: impl Into<String>) -> Self {
        Self { codec, reason: reason.into(), source: None }
    }

    /// Keeps the error that led to this one.
    #[must_use]
    pub fn caused_by(self, source: impl Into<Cause>) -> Self {
        Self { source: Some(source.into()), ..self }
    }

    /// The codec's name.
    pub fn codec(&self) -> &'static str {
        self.codec
    }

    /// Why the message cannot be written.
    pub fn reason(&self) -> &str {
        &self.reason
    }
}

/// Bytes that are no message of the expected type.
///
/// The usual causes are a peer that is no SCL program, and two programs built from different versions of a schema.
#[derive(Debug, thiserror::Error)]
#[error("codec `{codec}` cannot decode what arrived: {reason}")]
pub struct DecodeError {
    codec: &'static str,
    reason: String,
    source: Option<Cause>,
}

impl DecodeError {
    /// An error of the codec called `codec`; `reason` is lower case and ends without a full stop.
    pub fn new(codec: &'static str, reason: impl Into<String>) -> Self {
        Self { codec, reason: reason.into(), source: None }
    }

    /// Keeps the error that led to this one.
    #[must_use]
    pub fn caused_by(self, source: impl Into<Cause>) -> Self {
        Self { source: Some(source.into()), ..self }
    }

    /// The codec's name.
    pub fn codec(&self) -> &'static str {
        self.codec
    }

    /// Why the bytes are no message.
    pub fn reason(&self) -> &str {
        &self.reason
    }
}
