//! The programs under test.

use scl_tests::{Process, System};

pub(crate) const ARMS: &str = env!("CARGO_BIN_EXE_arms");
pub(crate) const BOUNDED: &str = env!("CARGO_BIN_EXE_bounded");
pub(crate) const CIRCLE: &str = env!("CARGO_BIN_EXE_circle");
pub(crate) const DROPPER: &str = env!("CARGO_BIN_EXE_dropper");
pub(crate) const EVENT_LOGGER: &str = env!("CARGO_BIN_EXE_event_logger");
pub(crate) const FRESH: &str = env!("CARGO_BIN_EXE_fresh");
pub(crate) const FUZZ_ROUND: &str = env!("CARGO_BIN_EXE_fuzz_round");
pub(crate) const IMAGES: &str = env!("CARGO_BIN_EXE_images");
pub(crate) const LATCHED: &str = env!("CARGO_BIN_EXE_latched");
pub(crate) const LEAVER: &str = env!("CARGO_BIN_EXE_leaver");
pub(crate) const LISTING1: &str = env!("CARGO_BIN_EXE_listing1");
pub(crate) const MOTORS: &str = env!("CARGO_BIN_EXE_motors");
pub(crate) const PEER: &str = env!("CARGO_BIN_EXE_peer");
pub(crate) const PLAIN: &str = env!("CARGO_BIN_EXE_plain");
pub(crate) const SHAPES: &str = env!("CARGO_BIN_EXE_shapes");
pub(crate) const SIGNALLED: &str = env!("CARGO_BIN_EXE_signalled");
pub(crate) const STEADY: &str = env!("CARGO_BIN_EXE_steady");
pub(crate) const STRANGER: &str = env!("CARGO_BIN_EXE_stranger");
pub(crate) const TAKER: &str = env!("CARGO_BIN_EXE_taker");
pub(crate) const TALKER: &str = env!("CARGO_BIN_EXE_talker");
pub(crate) const TWIN: &str = env!("CARGO_BIN_EXE_twin");
pub(crate) const WATCHED: &str = env!("CARGO_BIN_EXE_watched");
pub(crate) const UNTYPED: &str = env!("CARGO_BIN_EXE_untyped");

/// Starts `peer COMPONENT` and waits until the component is open.
#[track_caller]
pub(crate) fn open(system: &System, component: &str) -> Process {
    open_with(system, PEER, component)
}

/// Starts a program that prints `open` when its component is open.
#[track_caller]
pub(crate) fn open_with(system: &System, program: &str, component: &str) -> Process {
    let mut process = system.start(program, &[component]);
    process.expect("open");
    process
}
