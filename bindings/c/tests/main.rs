//! The C library as C programs use it: its header, and programs of the folder `programs` with this test as their peer.
#![allow(clippy::unwrap_used)]

mod bad_input;
mod calls;
mod counterpart;
mod event_loop;
mod header;
mod leaks;
mod page;
mod programs;
mod stopping;
mod threads;
