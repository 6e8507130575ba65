//! Flights of `examples/arcade`.
