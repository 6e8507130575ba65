//! The autopilot in Rust.

use arcade::Autopilot;
use arcade::flight_loop::{self, Memory};
use clap::Parser;
use scl::runtime_dir::RuntimeDir;

/// Turns readings into motor set-points. Keeps its state in the runtime folder of SCL, and carries on after a crash.
#[derive(Parser)]
struct Options {}

#[scl::main]
fn main(autopilot: Autopilot) -> scl::Result<()> {
    let Options {} = Options::parse();
    // The runtime folder belongs to this user alone, and is in memory on most systems.
    let folder = RuntimeDir::locate(&|name| std::env::var_os(name))?;
    // Each vehicle runs under its own system name, so each has its own file.
    let system = std::env::var("SCL_SYSTEM").ok().filter(|name| !name.is_empty());
    let file = format!("{}-autopilot.state", system.as_deref().unwrap_or("arcade"));
    flight_loop::run(autopilot, Memory::open(&folder.path().join(file)))
}
