//! What is done with bytes that come from outside: by the fuzz targets, and by the tests with generated input.

mod codecs;
mod generator;
mod record;

pub use codecs::{codecs, frames_of_every_codec};
pub use generator::Generator;
