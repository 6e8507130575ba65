//! Recording: from the taps of a running system into MCAP files.

mod disk_room;
mod file;
mod gate;

pub use file::WrittenFile;
