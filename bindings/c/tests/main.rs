//! The C library as C programs use it: its header, and programs of the folder `programs` with this test as their peer.
#![allow(clippy::unwrap_used)]

mod bad_input;
mod calls;
mod copies;
mod counterpart;
mod event_loop;
mod exits;
mod header;
mod parameters;
#[allow(dead_code, reason = "the tests with tools use the rest")]
mod programs;
mod stopping;
mod threads;
