//! The matrix of languages: programs in Rust, C, C++ and Python, and such with nothing but a ZeroMQ library, exchange
//! the same messages in every pattern, in any two of these languages.
//!
//! All follow the same commands, so each promise is one test for all pairs. What is told about accounts is exact.

mod exchange;
mod figures;
mod hostile;
mod latched;
mod program;
mod refusal;
mod restart;
mod stop;
