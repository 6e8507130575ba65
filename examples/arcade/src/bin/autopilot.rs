//! The autopilot in Rust.

use arcade::Autopilot;

#[scl::main]
fn main(_autopilot: Autopilot) -> scl::Result<()> {
    Ok(())
}
