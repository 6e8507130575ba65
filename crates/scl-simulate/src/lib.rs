//! Simulates a system in a test, in the time that its work takes and not its clock.
//!
//! [`Simulation`] calls `scl simulate`, which runs the programs of the system in simulated time, the same way each
//! time, and reads what was recorded. docs/simulate.md says what can be simulated.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod error;
mod simulated;
mod simulation;

pub use error::SimulationError;
pub use simulated::Simulated;
pub use simulation::Simulation;
