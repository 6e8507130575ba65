//! Runs the programs of a system in simulated time: the same way each time, and faster than real time.
//!
//! The programs run unchanged, as processes of their own, over their usual sockets. What differs:
//!
//! - Each loads a library before all others (`library/`), which takes the place of the C library's functions that wait
//!   or tell the time.
//! - One program runs at a time. It runs until each of its threads waits; then the library says until when, and the
//!   [`Conductor`] gives the next program a turn: one for which something has arrived, or whose time has come.
//! - When no program can go on, the conductor moves the time to the first instant that one waits for.
//!
//! So what happens depends only on the programs, their files and the seed.
#![cfg_attr(test, allow(clippy::unwrap_used))]

mod conductor;
mod faults;
mod network;
mod participant;
mod patience;
mod processor;
mod random;
mod routes;
mod scenario;
mod seed;
mod speed;

pub use conductor::{Conductor, Options};
pub use faults::{Effect, Fault};
pub use random::Between;
pub use scenario::{Expectation, Expected, Failure, Scenario, unmet};
