//! Tests with programs in other languages: C, C++ and Python with SCL, and any with nothing but a ZeroMQ library.

mod cpp;
mod interoperability;
mod json;
mod kinds;
mod languages;
mod plain;
#[allow(dead_code, reason = "the other tests start the rest")]
#[path = "../../tests/programs.rs"]
mod programs;
mod python;
mod python_bench;
mod python_generated;
mod python_typing;
mod python_values;
mod stats;
mod testing_page;
