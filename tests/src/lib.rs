//! What the tests across processes share: programs that follow commands, a runtime folder for them, and raw ZMTP peers.

mod cargo;
mod commands;
mod compile;
pub mod fuzz;
mod lock;
mod manager;
mod port;
mod process;
mod python;
mod raw_peer;
mod runtime_folder;
mod shared_memory;
mod stream;
mod system;
mod until;
mod usage;
pub mod zmtp;

pub use cargo::build;
pub use commands::{Commands, ranges, say, say_error, say_result, stop_self};
pub use compile::{CLibrary, Compile, c_library};
pub use lock::lock_file;
pub use manager::ServiceManager;
pub use port::free_address;
pub use process::{Exit, Process};
pub use python::{python_with_packages, python_with_scl, start_python};
pub use raw_peer::{Frame, RawListener, RawPeer};
pub use shared_memory::is_shared;
pub use stream::{Address, Stream};
pub use system::{System, on_each_transport};
pub use until::{HANG_LIMIT, NEVER, wait_for, wait_until};
