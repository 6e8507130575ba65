//! What the fuzz targets do with their input, and the tests with generated input.

mod codecs;
mod end;
mod frames;
mod generator;
mod litter;
mod record;
mod runtime_folder;
mod zmtp;

pub use codecs::{codecs, frames_of_every_codec};
pub use frames::{decoder, frames};
pub use generator::Generator;
pub use runtime_folder::runtime_folder;
