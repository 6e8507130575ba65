//! Flights: the simulated world and the autopilot in one process, faster than real time.

mod aircraft;
mod mission;
