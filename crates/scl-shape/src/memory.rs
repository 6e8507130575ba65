//! How much memory a message takes once it is decoded, estimated without decoding it.
//!
//! Two bytes of a frame can become a message of hundreds of bytes: an empty child in a repeated field. So the length of
//! a frame alone does not bound the memory. The estimate is an upper bound for `prost`, and approximately one for
//! libprotobuf, `protobuf-c` and upb.

mod json;
mod layout;
mod protobuf;

use layout::{Cost, Kind, MessageLayout};
use prost_types::FileDescriptorSet;

/// The language of the program that decodes the messages.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// Messages contain each other in place, and fields that the schema does not have are skipped.
    Rust,
    /// C, C++ and Python: messages point to each other, and unknown fields are kept.
    Other,
}

/// How a frame is encoded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Protobuf's binary encoding.
    Protobuf,
    /// Canonical protobuf JSON.
    Json,
}

/// Estimates the memory of decoded messages of one type.
#[derive(Debug, Clone)]
pub struct MemoryEstimate {
    /// The type itself, then those that it contains.
    messages: Vec<MessageLayout>,
    language: Language,
    format: Format,
}

impl MemoryEstimate {
    /// An estimate for messages of this full name. `None` if the files do not declare it or a type that it contains.
    pub fn new(files: &FileDescriptorSet, name: &str, language: Language, format: Format) -> Option<Self> {
        Some(Self { messages: layout::of(files, name, language)?, language, format })
    }

    /// The most memory that a byte of a frame can take, whatever the frame contains.
    pub fn most_per_byte(&self) -> u64 {
        match self.format {
            Format::Protobuf => protobuf::most_per_byte(&self.messages, self.language),
            Format::Json => json::most_per_byte(&self.messages),
        }
    }

    /// Returns how much memory decoding a frame takes, in bytes. For a damaged protobuf frame, that is the memory for
    /// the part before the damage; damaged JSON is an error, because every decoder refuses it.
    ///
    /// # Errors
    /// The text is not JSON, or nested deeper than 128 levels.
    pub fn of(&self, frame: &[u8]) -> Result<u64, NotJson> {
        match self.format {
            Format::Protobuf => Ok(protobuf::estimate(&self.messages, self.language, frame)),
            Format::Json => json::estimate(&self.messages, self.language, frame).map_err(NotJson),
        }
    }
}

/// A text that is not JSON.
#[derive(Debug)]
pub struct NotJson(serde_json::Error);

impl std::fmt::Display for NotJson {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "it is not JSON: {}", self.0)
    }
}

impl std::error::Error for NotJson {}

#[cfg(test)]
mod tests;
