//! Flights: the simulated world and the autopilot in one process, faster than real time.

mod aircraft;
mod faults;
mod mission;
mod programs;
mod timing;
