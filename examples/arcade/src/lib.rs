//! The Rust parts of the ARCADE aircraft: the simulated world, and an autopilot that is the twin of the one in C.
//!
//! | module | |
//! |---|---|
//! | [`world`] | physics: airframe, motors, battery, air, ground |
//! | [`sensors`] | what the sensors report of it |
//! | [`simulation`] | both, one step for each inertial reading |
//! | [`simulator`] | the program: real time, gates, and a serial port ([`serial`], [`nmea`]) |
//! | [`autopilot`] | estimation, navigation and control, once for each inertial reading |
//! | [`flight_loop`] | the program: gates and the state file |
//!
//! All but the two programs are free of clocks, gates and threads, so `tests/flight` flies faster than real time.

pub mod autopilot;
pub mod flight_loop;
pub mod geodesy;
pub mod nmea;
pub mod sensors;
pub mod serial;
pub mod simulation;
pub mod simulator;
pub mod watch;
pub mod world;

scl::topology!("topology.yaml", testable = true);
