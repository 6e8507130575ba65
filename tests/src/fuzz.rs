//! What is done with bytes that come from outside: by the fuzz targets, and by the tests with generated input.

mod codecs;
mod end;
mod frames;
mod generator;
mod litter;
mod record;
mod runtime_folder;
mod zmtp;

pub use codecs::{codecs, frames_of_every_codec};
pub use frames::frames;
pub use generator::Generator;
pub use runtime_folder::runtime_folder;
