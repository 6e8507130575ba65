//! The world, the airframe, its sensors and its motors.

use arcade::Simulator;

#[scl::main]
fn main(_simulator: Simulator) -> scl::Result<()> {
    Ok(())
}
